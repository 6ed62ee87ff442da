"""What each named effect does for the held-out recordings: the error with it and, the rest refitted, without it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.arm_search import Found
from lagnet.diagnosis.fitting import Fit, Workbench, fit_selection, take_off


@dataclass(frozen=True, eq=False)
class HeldOut:
    """Held-out errors of one effect, at its joint or averaged over the joints that it reaches.

    Args:
        without, with_it: nMSE.
        share: of the mismatch that it alone explains, 0 to 1.
        at_joints: joints where it helps.
        shares: shape (dof,), share of each joint's mismatch that it alone explains.
    """

    without: float
    with_it: float
    share: float
    at_joints: tuple[int, ...]
    shares: np.ndarray


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
    with_all = unseen_nmse(bench, found.fit, unseen, scale)
    nominal = np.array([t[-1, -1] for t in unseen.total]) / unseen.samples / scale**2
    out = {}
    for index in found.selection:
        rest = fit_selection(bench, [i for i in found.selection if i != index], sigma, folds=False)
        without = unseen_nmse(bench, rest, unseen, scale)
        joint = bench.library.hypotheses[index].joint
        far = bench.library.hypotheses[index].law.reaches_all
        at = np.flatnonzero(without > 1.02 * with_all) if far else np.array([joint])
        at = at if at.size else np.arange(len(scale))
        gained = without - with_all
        share = float(np.clip(np.sum(gained[at]) / max(1e-300, np.sum(nominal[at])), 0.0, 1.0))
        shares = np.clip(gained / np.maximum(nominal, 1e-300), 0.0, 1.0)
        errors = float(np.mean(without[at])), float(np.mean(with_all[at]))
        out[index] = HeldOut(*errors, share, tuple(int(j) for j in at), shares)
    return out
