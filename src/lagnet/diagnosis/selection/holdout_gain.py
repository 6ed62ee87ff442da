"""nMSE_without / nMSE_with of each effect on held-out recordings, all others refitted without it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from lagnet.diagnosis.regression.cross_validation import Fit, NormalEquations, fit_selection, take_off
from lagnet.diagnosis.selection.arm_search import Selection

OPPOSED = (
    0.5  # s: cosine of two torques, with the other sign, from which on one may stand for what the other gets wrong
)


@dataclass(frozen=True, eq=False)
class HoldoutGain:
    """Held-out errors of one effect, at its joint or averaged over the joints that it reaches.

    Args:
        without, with_it: nMSE, of the variance of the fitted torque.
        share: of the mismatch that it alone explains, 0 to 1.
        at_joints: joints where it helps.
        shares: shape (dof,), share of each joint's mismatch that it alone explains.
        silent: whether the held-out recordings hardly meet it, such as a limit that they never reach, so that what is
            held out are blocks of the fitted recordings, some at a time.
        powers: mean squared error without and with it at `at_joints`, shape (2, number of them) [N² m²].
    """

    without: float
    with_it: float
    share: float
    at_joints: tuple[int, ...]
    shares: np.ndarray
    silent: bool = False
    powers: np.ndarray = field(default_factory=lambda: np.zeros((2, 0)))

    def of_variance(self, variance: np.ndarray) -> tuple[float, float]:
        """Errors without and with it, averaged over its joints, as parts of a variance of shape (dof,) [N² m²]."""
        without, with_it = (self.powers / variance[list(self.at_joints)]).mean(axis=1)
        return float(without), float(with_it)


def unseen_nmse(equations: NormalEquations, fit: Fit, unseen: NormalEquations, scale: np.ndarray) -> np.ndarray:
    """nMSE of a fit on held-out blocks, shape (dof,)."""
    return error_of(fit, unseen) / unseen.samples / scale**2


def error_of(fit: Fit, unseen: NormalEquations) -> np.ndarray:
    """E_j = Σ (r_j − X_j θ)² from normal equations, shape (dof,) [N² m²]."""
    error = np.zeros(unseen.library.n_dof)
    for joint, total in enumerate(unseen.total):
        own = [i for i in fit.selection if i in unseen.library.slots[joint]]
        theta = np.concatenate([fit.coefficients[i] for i in own]) if own else np.zeros(0)
        error[joint] = max(0.0, take_off(total, unseen.columns(joint, own), theta)[-1, -1])
    return error


def holdout_gains(
    equations: NormalEquations, unseen: NormalEquations, found: Selection, scale: np.ndarray, sigma: np.ndarray
) -> dict[int, HoldoutGain]:
    """The held-out errors with and without each selected hypothesis."""
    return {index: _part(equations, unseen, found, index, scale, sigma) for index in found.indices}


def _part(
    equations: NormalEquations,
    unseen: NormalEquations,
    found: Selection,
    index: int,
    scale: np.ndarray,
    sigma: np.ndarray,
) -> HoldoutGain:
    rest = [i for i in found.indices if i != index]
    silent = _is_silent(found.fit, unseen, index)
    if silent:
        with_all, without = (_in_turn(equations, chosen, scale, sigma) for chosen in (found.indices, rest))
    else:
        fewer = fit_selection(equations, rest, sigma, folds=False)
        with_all, without = (unseen_nmse(equations, fit, unseen, scale) for fit in (found.fit, fewer))
    nominal = _nominal_nmse(equations if silent else unseen, scale)
    h = equations.library.hypotheses[index]
    at = np.flatnonzero(without > equations.limits.least_ratio * with_all) if h.law.reaches_all else np.array([h.joint])
    at = at if at.size else np.arange(len(scale))
    gained = without - with_all
    share = float(np.clip(np.sum(gained[at]) / max(1e-300, np.sum(nominal[at])), 0.0, 1.0))
    shares = np.clip(gained / np.maximum(nominal, 1e-300), 0.0, 1.0)
    powers = np.array([without[at], with_all[at]]) * scale[at] ** 2
    return HoldoutGain(
        float(np.mean(without[at])), float(np.mean(with_all[at])), share, tuple(map(int, at)), shares, silent, powers
    )


def ratio_without(
    equations: NormalEquations, unseen: NormalEquations, found: Selection, group: tuple[int, ...], sigma: np.ndarray
) -> float:
    """Held-out error without some effects over that with them, the others refitted: the largest of their joints."""
    fewer = fit_selection(equations, [i for i in found.indices if i not in group], sigma, folds=False)
    with_all, without = error_of(found.fit, unseen), error_of(fewer, unseen)
    at = [j for j in range(len(without)) if any(i in unseen.library.slots[j] for i in group)]
    return float(np.max(without[at] / np.maximum(with_all[at], 1e-300)))


def opposed_pairs(unseen: NormalEquations, found: Selection) -> list[tuple[int, int]]:
    """Pairs of effects whose held-out torques oppose each other at a joint: Σ τ_i τ_k < −s √(Σ τ_i² Σ τ_k²)."""
    opposed = set()
    for joint, total in enumerate(unseen.total):
        own = [i for i in found.indices if i in unseen.library.slots[joint]]
        parts = [(unseen.columns(joint, [i]), found.fit.coefficients[i]) for i in own]
        products = np.array([[s @ total[np.ix_(a, b)] @ t for b, t in parts] for a, s in parts])
        size = np.sqrt(np.diag(products)) if own else np.zeros(0)
        against = np.argwhere(np.triu(products < -OPPOSED * np.outer(size, size), 1))
        opposed |= {(own[i], own[k]) for i, k in against}
    return sorted(opposed)


def of_one_joint(unseen: NormalEquations, found: Selection) -> list[tuple[int, ...]]:
    """All effects of each joint that has more than two; two that cancel each other are a pair."""
    library = unseen.library
    places = [[i for i in found.indices if library.hypotheses[i].joint == j] for j in range(library.n_dof)]
    return [tuple(own) for own in places if len(own) > 2]


def _nominal_nmse(equations: NormalEquations, scale: np.ndarray) -> np.ndarray:
    return np.array([t[-1, -1] for t in equations.total]) / equations.samples / scale**2


def _in_turn(equations: NormalEquations, selection: Sequence[int], scale: np.ndarray, sigma: np.ndarray) -> np.ndarray:
    """nMSE on groups of blocks of the fitted recordings, each predicted by a fit to the others, shape (dof,)."""
    return fit_selection(equations, selection, sigma).sse / equations.samples / scale**2


def _is_silent(fit: Fit, unseen: NormalEquations, index: int) -> bool:
    """Whether an effect as fitted adds so little to the held-out torque that even the true law could not pass there."""
    theta = fit.coefficients[index]
    left = error_of(fit, unseen)
    for joint, total in enumerate(unseen.total):
        columns = unseen.columns(joint, [index])
        if (
            columns.size
            and theta @ total[np.ix_(columns, columns)] @ theta > (unseen.limits.least_ratio - 1.0) * left[joint]
        ):
            return False
    return True
