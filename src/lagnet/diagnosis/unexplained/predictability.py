"""1 − E(model)/E(0): share of a residual that a flexible function of state and short history predicts on new motion.

The better of two functions counts, one of all signals and one of the joint's own position and speed: trees that are
given dozens of signals may learn to tell recordings apart, which predicts nothing of new motion.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from threadpoolctl import threadpool_limits

from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.diagnosis.regression.plain_terms import sparse_share

if TYPE_CHECKING:
    from sklearn.ensemble import HistGradientBoostingRegressor

MOST = 4_000  # training samples
FEWEST = 50  # of them, below which nothing is told
HISTORY = 0.5  # how far back the short history looks, in periods of the bandwidth
STRONGEST = 4  # signals that are reported
LEAST_EFFECT = 0.05  # of the residual power, below which a signal is not reported as predicting it


@dataclass(frozen=True, eq=False)
class Predictability:
    """Predictable share of one joint's residual and the signals that it depends on.

    Args:
        share: predicted share of the residual's power on held-out motion, 0 to 1.
        depends_on: signals that predict it, strongest first, such as q_2 or v_4.
    """

    share: float
    depends_on: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Signals:
    """Input signals of the flexible model at the kept samples.

    Args:
        names: one a column.
        table: shape (n, n_signals).
    """

    names: tuple[str, ...]
    table: np.ndarray

    def of(self, name: str) -> np.ndarray:
        """One signal by its name, shape (n,)."""
        return self.table[:, self.names.index(name)]

    def of_joint(self, joint: int) -> Signals:
        """Position and speed of one joint."""
        names = (f"q_{joint}", f"v_{joint}")
        return Signals(names, np.column_stack([self.of(n) for n in names]))

    def only(self, rows: np.ndarray) -> Signals:
        """The signals of some samples."""
        return Signals(self.names, self.table[rows])


def signals_of(problem: Problem, pieces: tuple[Segment, ...]) -> Signals:
    """Positions, velocities, accelerations, load and the velocities a moment before."""
    dof = problem.n_dof
    names = [f"{s}_{j}" for s in ("q", "v", "a", "load") for j in range(dof)] + [f"history_{j}" for j in range(dof)]
    back = max(1, int(HISTORY * problem.rate / problem.bandwidth))
    rows = []
    for p in pieces:
        before = p.v[np.maximum(p.keep - back, 0)]
        rows.append(np.hstack([p.q[p.keep], p.v[p.keep], p.a[p.keep], p.load[p.keep], before]))
    return Signals((*names, "time"), np.hstack([np.vstack(rows), _time(pieces)[:, None]]))


def _time(pieces: tuple[Segment, ...]) -> np.ndarray:
    return np.concatenate([p.time[p.keep] for p in pieces])


def predictability_of(
    signals: Signals,
    residual: np.ndarray,
    counts: np.ndarray,
    unseen: Signals,
    unseen_residual: np.ndarray,
    joint: int,
    seed: int,
) -> Predictability:
    """Boosted trees or a few plain terms, whichever does better, on the fit samples, judged on the held-out ones.

    Args:
        residual, unseen_residual: shape (n,), (m,), one joint [N m].
        counts: shape (n,), samples of the fit that count.
        joint: the joint.
    """
    rng = np.random.default_rng(seed)
    rows = _rows(counts, rng)
    power = float(np.mean(unseen_residual**2))
    if rows.size < FEWEST or not power > 0:
        return Predictability(0.0, ())
    y = residual[rows]
    pairs = ((signals, unseen), (signals.of_joint(joint), unseen.of_joint(joint)))
    with threadpool_limits(1):
        found = [_by_trees(seen.table[rows], y, new, unseen_residual, power, seed, rng) for seen, new in pairs]
    plain, terms = sparse_share(signals.names, signals.table[rows], y, unseen.table, unseen_residual)
    if plain > LEAST_EFFECT:
        found = [Predictability(plain, terms[:STRONGEST]), *found]
    return max(reversed(found), key=lambda one: one.share)


def _by_trees(
    x: np.ndarray,
    y: np.ndarray,
    unseen: Signals,
    truth: np.ndarray,
    power: float,
    seed: int,
    rng: np.random.Generator,
) -> Predictability:
    trees = _trees(x, y, seed)
    error = _error(trees, unseen.table, truth)
    share = float(np.clip(1.0 - error / power, 0.0, 1.0))
    names = _strongest(trees, unseen, truth, error, power, rng) if share > LEAST_EFFECT else ()
    return Predictability(share, names)


def is_predictable(
    signals: Signals,
    residual: np.ndarray,
    counts: np.ndarray,
    unseen: Signals,
    unseen_residual: np.ndarray,
    joint: int,
    seed: int,
    least: float,
) -> bool:
    """Whether `predictability_of` tells a share above the least one, found with as little work as that takes."""
    rows = _rows(counts, np.random.default_rng(seed))
    power = float(np.mean(unseen_residual**2))
    if rows.size < FEWEST or not power > 0:
        return False
    y = residual[rows]
    if sparse_share(signals.names, signals.table[rows], y, unseen.table, unseen_residual)[0] > least:
        return True
    pairs = ((signals.of_joint(joint), unseen.of_joint(joint)), (signals, unseen))
    with threadpool_limits(1):
        trees = ((_trees(seen.table[rows], y, seed), new) for seen, new in pairs)
        return any(_error(one, new.table, unseen_residual) < (1.0 - least) * power for one, new in trees)


def _rows(counts: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Samples that trees are grown on, at random among those that count."""
    return np.sort(rng.permutation(np.flatnonzero(counts))[:MOST])


def _trees(table: np.ndarray, residual: np.ndarray, seed: int) -> HistGradientBoostingRegressor:
    from sklearn.ensemble import HistGradientBoostingRegressor  # slow to import, and used where something is left

    trees = HistGradientBoostingRegressor(
        max_iter=60, max_leaf_nodes=12, learning_rate=0.12, min_samples_leaf=20, random_state=seed
    )
    return trees.fit(table, residual)


def _error(trees: HistGradientBoostingRegressor, table: np.ndarray, truth: np.ndarray) -> float:
    return float(np.mean((truth - trees.predict(table)) ** 2))


def _strongest(trees, unseen: Signals, truth: np.ndarray, error: float, power: float, rng) -> tuple[str, ...]:
    """Signals with the largest permutation importance."""
    rows = np.sort(rng.permutation(truth.size)[:1500])
    table, truth = unseen.table[rows], truth[rows]
    error = _error(trees, table, truth)
    losses = {}
    for k, name in enumerate(unseen.names):
        shuffled = table.copy()
        shuffled[:, k] = rng.permutation(shuffled[:, k])
        losses[name] = _error(trees, shuffled, truth) - error
    ranked = sorted(losses, key=lambda n: -losses[n])
    return tuple(n for n in ranked if losses[n] > LEAST_EFFECT * power)[:STRONGEST]
