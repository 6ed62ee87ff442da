"""What each named effect does for the held-out recordings: the error with it and, the rest refitted, without it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from lagnet.diagnosis.arm_search import Found
from lagnet.diagnosis.fitting import Fit, Workbench, fit_selection, take_off

HARMLESS = 1.02  # an effect stays if the held-out error without it is larger by at least this factor


@dataclass(frozen=True, eq=False)
class HeldOut:
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


def unseen_nmse(bench: Workbench, fit: Fit, unseen: Workbench, scale: np.ndarray) -> np.ndarray:
    """nMSE of a fit on held-out blocks, shape (dof,)."""
    return error_of(fit, unseen) / unseen.samples / scale**2


def error_of(fit: Fit, unseen: Workbench) -> np.ndarray:
    """Squared error of a fit on the blocks of a workbench, shape (dof,)."""
    error = np.zeros(unseen.library.n_dof)
    for joint, total in enumerate(unseen.total):
        own = [i for i in fit.selection if i in unseen.library.slots[joint]]
        theta = np.concatenate([fit.coefficients[i] for i in own]) if own else np.zeros(0)
        error[joint] = max(0.0, take_off(total, unseen.columns(joint, own), theta)[-1, -1])
    return error


def held_out_evidence(
    bench: Workbench, unseen: Workbench, found: Found, scale: np.ndarray, sigma: np.ndarray
) -> dict[int, HeldOut]:
    """For each selected hypothesis its part in the held-out fit."""
    return {index: _part(bench, unseen, found, index, scale, sigma) for index in found.selection}


def _part(
    bench: Workbench, unseen: Workbench, found: Found, index: int, scale: np.ndarray, sigma: np.ndarray
) -> HeldOut:
    rest = [i for i in found.selection if i != index]
    silent = _is_silent(found.fit, unseen, index)
    if silent:
        with_all, without = (_in_turn(bench, chosen, scale, sigma) for chosen in (found.selection, rest))
    else:
        fewer = fit_selection(bench, rest, sigma, folds=False)
        with_all, without = (unseen_nmse(bench, fit, unseen, scale) for fit in (found.fit, fewer))
    nominal = _nominal_nmse(bench if silent else unseen, scale)
    h = bench.library.hypotheses[index]
    at = np.flatnonzero(without > HARMLESS * with_all) if h.law.reaches_all else np.array([h.joint])
    at = at if at.size else np.arange(len(scale))
    gained = without - with_all
    share = float(np.clip(np.sum(gained[at]) / max(1e-300, np.sum(nominal[at])), 0.0, 1.0))
    shares = np.clip(gained / np.maximum(nominal, 1e-300), 0.0, 1.0)
    powers = np.array([without[at], with_all[at]]) * scale[at] ** 2
    return HeldOut(
        float(np.mean(without[at])), float(np.mean(with_all[at])), share, tuple(map(int, at)), shares, silent, powers
    )


def _nominal_nmse(bench: Workbench, scale: np.ndarray) -> np.ndarray:
    return np.array([t[-1, -1] for t in bench.total]) / bench.samples / scale**2


def _in_turn(bench: Workbench, selection: Sequence[int], scale: np.ndarray, sigma: np.ndarray) -> np.ndarray:
    """nMSE on groups of blocks of the fitted recordings, each predicted by a fit to the others, shape (dof,)."""
    return fit_selection(bench, selection, sigma).sse / bench.samples / scale**2


def _is_silent(fit: Fit, unseen: Workbench, index: int) -> bool:
    """Whether an effect as fitted adds so little to the held-out torque that even the true law could not pass there."""
    theta = fit.coefficients[index]
    left = error_of(fit, unseen)
    for joint, total in enumerate(unseen.total):
        columns = unseen.columns(joint, [index])
        if columns.size and theta @ total[np.ix_(columns, columns)] @ theta > (HARMLESS - 1.0) * left[joint]:
            return False
    return True
