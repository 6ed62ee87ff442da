"""|r_j(t)| / σ_τj along a held-out motion, nominal and corrected, in few enough frames to play on a page."""

from __future__ import annotations

from typing import Any

import numpy as np

from lagnet.diagnosis.verdict.report_data import ArmMotion
from lagnet.rigid_body.body_tree import TreeBody

FRAMES = 600
LONGEST = 40.0  # [s]


def arm_motion(
    model: Any,
    time: np.ndarray,
    q: np.ndarray,
    residuals: tuple[np.ndarray, np.ndarray],
    scale: np.ndarray,
) -> ArmMotion | None:
    """The first seconds of one motion, in frames; None where the model has no bodies or the motion is too short.

    Args:
        model: whose bodies are drawn.
        time: shape (n,), of one unbroken motion [s].
        q: shape (n, dof) [rad].
        residuals: of the nominal and of the corrected model, each of shape (n, dof) [N m].
        scale: shape (dof,), standard deviation of the measured torque [N m].
    """
    if time.size < 3 or not hasattr(model, "body_tree"):
        return None
    tree = model.body_tree()
    kept = time <= time[0] + LONGEST
    clock = np.linspace(time[0], time[kept][-1], min(FRAMES, int(kept.sum())))
    at = [np.column_stack([np.interp(clock, time, x) for x in signal.T]) for signal in (q, *map(np.abs, residuals))]
    tip = _in_last_frame(tree, model.skeleton(np.zeros(q.shape[1]))[-1])
    return ArmMotion(tree, tip, clock - clock[0], at[0], at[1] / scale, at[2] / scale)


def _in_last_frame(tree: tuple[TreeBody, ...], point: np.ndarray) -> np.ndarray:
    """A point of the base in the frame of the last joint, all joints at zero."""
    chain, k = [], len(tree) - 1
    while k >= 0:
        chain.append(tree[k])
        k = tree[k].parent
    for body in reversed(chain):
        point = body.rotation.T @ (point - body.position)
    return point
