"""1 − E(model)/E(0): share of a residual that a flexible function of state and short history predicts on new motion.

The better of two functions counts, one of all signals and one of the joint's own position and speed: trees that are
given dozens of signals may learn to tell recordings apart, which predicts nothing of new motion.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
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


@dataclass(frozen=True, eq=False)
class Examples:
    """The residual of one joint on motion to learn from and on motion to be judged on.

    Args:
        joint: the joint.
        seen, unseen: signals of the two motions.
        residual, truth: shape (n,), (m,), the residual on each [N m].
        counts: shape (n,), samples to learn from that count.
    """

    joint: int
    seen: Signals
    residual: np.ndarray
    counts: np.ndarray
    unseen: Signals
    truth: np.ndarray

    @property
    def power(self) -> float:
        """Mean square residual to be predicted [N² m²]."""
        return float(np.mean(self.truth**2))

    def of_own_joint(self) -> Examples:
        """The same with the position and speed of the joint alone."""
        return replace(self, seen=self.seen.of_joint(self.joint), unseen=self.unseen.of_joint(self.joint))

    def learned(self, rng: np.random.Generator) -> Examples | None:
        """With some samples to learn from, at random among those that count; None where these are too few."""
        rows = np.sort(rng.permutation(np.flatnonzero(self.counts))[:MOST])
        if rows.size < FEWEST or not self.power > 0:
            return None
        return replace(self, seen=self.seen.only(rows), residual=self.residual[rows], counts=self.counts[rows])


def predictability_of(examples: Examples, seed: int) -> Predictability:
    """Boosted trees or a few plain terms, whichever does better, on the fit samples, judged on the held-out ones."""
    rng = np.random.default_rng(seed)
    few = examples.learned(rng)
    if few is None:
        return Predictability(0.0, ())
    with threadpool_limits(1):
        found = [_by_trees(one, seed, rng) for one in (few, few.of_own_joint())]
    plain, terms = _by_plain_terms(few)
    if plain > LEAST_EFFECT:
        found = [Predictability(plain, terms[:STRONGEST]), *found]
    return max(reversed(found), key=lambda one: one.share)


def is_predictable(examples: Examples, seed: int, least: float) -> bool:
    """Whether `predictability_of` tells a share above the least one, found with as little work as that takes."""
    few = examples.learned(np.random.default_rng(seed))
    if few is None:
        return False
    if _by_plain_terms(few)[0] > least:
        return True
    with threadpool_limits(1):
        grown = ((_trees(one, seed), one) for one in (few.of_own_joint(), few))
        return any(_error(t, one.unseen.table, one.truth) < (1.0 - least) * few.power for t, one in grown)


def _by_plain_terms(few: Examples) -> tuple[float, tuple[str, ...]]:
    return sparse_share(few.seen.names, few.seen.table, few.residual, few.unseen.table, few.truth)


def _by_trees(few: Examples, seed: int, rng: np.random.Generator) -> Predictability:
    trees, power = _trees(few, seed), few.power
    error = _error(trees, few.unseen.table, few.truth)
    share = float(np.clip(1.0 - error / power, 0.0, 1.0))
    names = _strongest(trees, few.unseen, few.truth, error, power, rng) if share > LEAST_EFFECT else ()
    return Predictability(share, names)


def _trees(few: Examples, seed: int) -> HistGradientBoostingRegressor:
    from sklearn.ensemble import HistGradientBoostingRegressor  # slow to import, and used where something is left

    trees = HistGradientBoostingRegressor(
        max_iter=60, max_leaf_nodes=12, learning_rate=0.12, min_samples_leaf=20, random_state=seed
    )
    return trees.fit(few.seen.table, few.residual)


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
