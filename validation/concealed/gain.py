"""How much of the true law's gain in held-out error the named physics reach."""

from __future__ import annotations

import io

import numpy as np
import pyarrow.parquet as pq
from scipy.signal import butter, sosfiltfilt

from validation.plants.body import joint_names
from validation.plants.catalogue.costs import Costs
from validation.plants.catalogue.listed import DRY, GEARS
from validation.plants.catalogue.plan import Plan
from validation.plants.catalogue.witness import AT_REST

BEHIND_A_GEAR = 5.0  # [Hz]: faster, the true law follows accelerations that no recording at 100 Hz resolves


def gain_shares(plan: Plan, torques: bytes, truth: Costs) -> tuple[float | None, float | None]:
    """Gain of the corrected model over the gain of the plant's own noise-free extra torque, summed over all joints.

    Squared errors on the raw held-out samples, in units of each joint's variance. A joint with dry friction holds any
    torque up to its level while it rests, which no law of the motion gives: the first share leaves those samples out,
    the second counts them. Behind a gear
    with a second mass errors are compared below 5 Hz. None where the true law gains nothing on the held-out motion.

    Args:
        plan: the opened plant.
        torques: content of holdout_torque.parquet.
        truth: costs along the held-out recording.
    """
    table = pq.read_table(io.BytesIO(torques)).to_pydict()
    dof = truth.beyond.shape[1]
    shown = {
        k: np.column_stack([table[f"tau_{k}_{j}"] for j in range(dof)]) for k in ("measured", "nominal", "corrected")
    }
    every = np.ones(truth.beyond.shape, dtype=bool)
    gear = any(hidden.effect in GEARS for hidden in plan.hidden)
    seen = np.asarray(butter(4, BEHIND_A_GEAR / (plan.rate / 2), output="sos")) if gear else None
    return _share(shown, truth, _in_motion(plan, truth), seen), _share(shown, truth, every, seen)


def _in_motion(plan: Plan, truth: Costs) -> np.ndarray:
    """Samples (n, dof) at which the true law is a function of the motion."""
    names = joint_names(plan.robot)
    moving = np.ones(truth.v.shape, dtype=bool)
    for hidden in plan.hidden:
        if hidden.effect in DRY and hidden.joint is not None:
            speed = np.abs(truth.v[:, names.index(hidden.joint)])
            moving[:, names.index(hidden.joint)] = speed > AT_REST * speed.max()
    return moving


def _share(shown: dict[str, np.ndarray], truth: Costs, on: np.ndarray, seen: np.ndarray | None) -> float | None:
    power = np.maximum(np.var(shown["measured"], axis=0), 1e-12)
    wrong = shown["measured"] - shown["nominal"]

    def error(residual: np.ndarray) -> float:
        if seen is not None:
            residual = sosfiltfilt(seen, residual, axis=0)
        return float(np.sum(np.mean(np.where(on, residual, 0.0) ** 2, axis=0) / power))

    possible = error(wrong) - error(wrong - truth.beyond)
    reached = error(wrong) - error(shown["measured"] - shown["corrected"])
    return reached / possible if possible > 0 else None
