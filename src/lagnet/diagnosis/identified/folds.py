"""Cross-validation of the identified layer over contiguous blocks: statistical inefficiency, couplings and joints."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from lagnet.diagnosis.identified.design import Design, Group
from lagnet.diagnosis.identified.dictionary import GAIN, PATH
from lagnet.diagnosis.identified.equations import JointEquations, joint_equations
from lagnet.diagnosis.identified.evidence import START, Ridge, fit_ridge, solve_beside

FOLDS = 6
GUARD = 3  # samples left out on both sides of a block: the length of the filter's response
INEFFICIENCIES = (3.0, 10.0, 20.0, 40.0)  # candidates for the statistical inefficiency
COUPLED = 0.5  # largest held-out error of a joint with a coupling over that without
MUCH = 0.005  # held-out error over the variance of the target, above which functions of the joint's position are tried
BETTER = 0.8  # largest held-out error with these over that without, in the product over all joints
FRICTION_BETTER = 0.5  # the same of friction that changes over the range, which speaks against the names of friction
SCREENED = 0.8  # of the joint's fitted error, all else held fixed: what lowers it by less is not validated
SCALED = 0.5  # largest held-out error with a scale of recorded torque over that without, in the product over all joints
MAYBE = 0.8  # of the fitted error: what lowers this by less does not halve that of held-out blocks
IDLE = 0.98  # held-out error over the power of the target, above which a joint needs no terms
FIRST, STEPS = 25, 5  # steps of the evidence's fixed point, initially and from a fit nearby


@dataclass(frozen=True, eq=False)
class Fold:
    """Normal equations of all joints in one block, held out, and outside it, fitted."""

    held_out: tuple[JointEquations, ...]
    fitted: tuple[JointEquations, ...]


def block_folds(design: Design, n_folds: int = FOLDS) -> tuple[Fold, ...]:
    """Contiguous blocks of about equal length, with a guard of samples around each that are in neither part.

    Args:
        design: the equations, in the order of time.
        n_folds: number of blocks.
    """
    n, total, out = design.joints[0].target.size, joint_equations(design), []
    edges = np.linspace(0, n, n_folds + 1).round().astype(int)
    for first, last in pairwise(edges.tolist()):
        near = joint_equations(design, slice(max(0, first - GUARD), last + GUARD))
        fitted = tuple(w - s for w, s in zip(total, near, strict=True))
        out.append(Fold(joint_equations(design, slice(first, last)), fitted))
    return tuple(out)


@dataclass(frozen=True, eq=False)
class Choice:
    """A fit to all rows, with its cross-validated error.

    Args:
        ridge: the fit.
        inefficiency: samples with the information of one.
        excluded: indices of groups that are fixed at zero.
        nmse: shape (dof,), squared error on held-out blocks over the power of the target.
    """

    ridge: Ridge
    inefficiency: float
    excluded: frozenset[int]
    nmse: np.ndarray

    @property
    def score(self) -> float:
        """Σ_j ln nmse_j: joints have equal weight."""
        return float(np.sum(np.log(np.maximum(self.nmse, 1e-300))))


def choose(design: Design, inefficiencies: Sequence[float] = INEFFICIENCIES) -> Choice | None:
    """argmin of the score over inefficiencies, couplings and joints with terms; None where no joint is predicted."""
    rows, groups = _Rows(design, joint_equations(design), block_folds(design)), design.groups
    excluded = frozenset(i for i, g in enumerate(groups) if g.optional)
    best = min(_fits_by_inefficiency(rows, inefficiencies, excluded), key=lambda c: c.score)
    pairs, alone = {g.pair for g in groups if g.pair}, [i for i in excluded if _is_alone(groups[i])]
    near = _beside(rows, best.ridge, best.inefficiency, excluded)
    needed = frozenset(i for i in alone if _is_needed(rows, near, i))
    needed = needed.union(*(_coupling(rows, near, pair) for pair in pairs))
    needed |= _scales(rows, near, needed)
    told = {groups[i].joint for i in needed}
    idle = {j for j in range(len(design.joints)) if best.nmse[j] > IDLE and j not in told}
    if needed or idle:
        without = (excluded - needed) | {i for i, g in enumerate(groups) if g.joint in idle}
        best = min(_fits_by_inefficiency(rows, inefficiencies, without), key=lambda c: c.score)
    return best if np.any(best.nmse <= IDLE) else None


def _is_alone(group: Group) -> bool:
    """Whether a group is of one joint, and says nothing of the scale of another."""
    return group.joint is not None and group.name != GAIN


@dataclass(frozen=True, eq=False)
class _Rows:
    """The equations, with the normal equations of all rows and those of each block held out, summed once."""

    design: Design
    total: tuple[JointEquations, ...]
    folds: tuple[Fold, ...]


def _coupling(rows: _Rows, best: Choice, pair: tuple[int, int]) -> frozenset[int]:
    """The groups that couple a pair of joints, where one of them is predicted far better with them; else none."""
    own = frozenset(i for i, g in enumerate(rows.design.groups) if g.pair == pair)
    ridge = _freed(rows, best, own)
    if not np.any(_fitted_ratio(ridge, best)[list(pair)] < MAYBE):
        return frozenset()
    coupled = _beside(rows, ridge, best.inefficiency, best.excluded - own)
    return own if np.any((coupled.nmse < COUPLED * best.nmse)[list(pair)]) else frozenset()


def _scales(rows: _Rows, best: Choice, needed: frozenset[int]) -> frozenset[int]:
    """Gains of joints, the most telling first, while each halves the error of held-out blocks; of one joint never.

    Links are felt at several joints: a sensor that scales one joint's torque contradicts the others. Were the scales of
    all joints free, that of the bodies would be, too.
    """
    gains = frozenset(i for i, g in enumerate(rows.design.groups) if g.name == GAIN)
    found, current = frozenset[int](), _with(rows, best, needed) if needed else best
    while len(found) < len(gains) - 1:
        freed = {i: _freed(rows, current, frozenset({i})) for i in gains - found}
        likely = [i for i, ridge in freed.items() if np.prod(_fitted_ratio(ridge, current)) < MAYBE]
        tried = {i: _beside(rows, freed[i], best.inefficiency, current.excluded - {i}) for i in likely}
        most = min(tried, key=lambda i: tried[i].score, default=None)
        if most is None or tried[most].score > current.score + np.log(SCALED):
            break
        found, current = found | {most}, tried[most]
    return found


def _is_needed(rows: _Rows, best: Choice, index: int) -> bool:
    """Whether held-out blocks are predicted better with an optional group of one joint."""
    group = rows.design.groups[index]
    joint, better = group.joint, FRICTION_BETTER if group.name == PATH else BETTER
    if joint is None or best.nmse[joint] < MUCH * _variance_share(rows, joint):
        return False
    if _screened_ratio(rows, best, joint, index) > SCREENED:
        return False
    return _with(rows, best, frozenset({index})).score < best.score + float(np.log(better))


def _variance_share(rows: _Rows, joint: int) -> float:
    """Variance over power of a joint's target: an offset explains the rest."""
    own, power = rows.design.joints[joint], rows.total[joint].power
    target = own.target[own.valid]
    return float(np.sum((target - target.mean()) ** 2)) / power if power > 0.0 else 1.0


def _screened_ratio(rows: _Rows, best: Choice, joint: int, index: int) -> float:
    """Squared error of a joint with a group and its other functions free over that without, all else held fixed."""
    own, sums, groups = rows.design.joints[joint], rows.total[joint], rows.design.groups
    free = [g.unknowns for i, g in enumerate(groups) if i == index or (g.joint == joint and i not in best.excluded)]
    at = np.flatnonzero(np.isin(own.unknowns, np.concatenate(free)) & (rows.design.scale[own.unknowns] > 0))
    x = best.ridge.x[own.unknowns]
    rest = (sums.moment - sums.gram @ x)[at]
    gram = sums.gram[np.ix_(at, at)]
    gram[np.diag_indices(at.size)] += 1e-9 * np.trace(gram) / max(1, at.size)
    gained = float(rest @ np.linalg.solve(gram, rest)) if gram.any() else 0.0
    return 1.0 - gained / max(sums.error(x), 1e-300)


def _with(rows: _Rows, best: Choice, own: frozenset[int]) -> Choice:
    return _beside(rows, _freed(rows, best, own), best.inefficiency, best.excluded - own)


def _freed(rows: _Rows, best: Choice, own: frozenset[int]) -> Ridge:
    """The fit to all rows from another one, with some excluded groups free."""
    precision = best.ridge.precision.copy()
    for i in own:
        precision[rows.design.groups[i].unknowns] = START
    start = replace(best.ridge, precision=precision)
    return fit_ridge(rows.design, rows.total, best.inefficiency, start, STEPS, best.excluded - own)


def _fitted_ratio(ridge: Ridge, before: Choice) -> np.ndarray:
    """Squared error on all rows, to which both are fitted, over that of another fit, shape (dof,)."""
    return ridge.variance / np.maximum(before.ridge.variance, 1e-300)


def _beside(rows: _Rows, ridge: Ridge, inefficiency: float, excluded: frozenset[int]) -> Choice:
    """A fit to all rows, and the error on each block of the fit to the others with the same α and σ²."""
    xs = [solve_beside(rows.design, fold.fitted, inefficiency, ridge) for fold in rows.folds]
    return Choice(ridge, inefficiency, excluded, _unseen(rows, xs))


def _fits_by_inefficiency(rows: _Rows, inefficiencies: Sequence[float], excluded: frozenset[int]) -> Iterator[Choice]:
    start = None
    for inefficiency in inefficiencies:
        choice = _validated(rows, inefficiency, excluded, start)
        start = choice.ridge
        yield choice


def _validated(rows: _Rows, inefficiency: float, excluded: frozenset[int], start: Ridge | None = None) -> Choice:
    """A fit to all rows, and the error on each block of the fit to the others from the same α and σ²."""
    steps = FIRST if start is None else STEPS
    ridge = fit_ridge(rows.design, rows.total, inefficiency, start, steps, excluded)
    parts = [fit_ridge(rows.design, fold.fitted, inefficiency, ridge, STEPS, excluded) for fold in rows.folds]
    return Choice(ridge, inefficiency, excluded, _unseen(rows, [part.x for part in parts]))


def _unseen(rows: _Rows, xs: Sequence[np.ndarray]) -> np.ndarray:
    """Squared error on each block with an x of its own, over the power of the target, shape (dof,)."""
    errors, joints = np.zeros(len(rows.design.joints)), rows.design.joints
    for x, fold in zip(xs, rows.folds, strict=True):
        errors += [s.error(x[j.unknowns]) for s, j in zip(fold.held_out, joints, strict=True)]
    return errors / np.array([max(s.power, 1e-300) for s in rows.total])
