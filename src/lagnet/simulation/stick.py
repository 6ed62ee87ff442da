"""Solve joint friction within a step, so that light joints do not chatter when friction is steep around standstill."""

from __future__ import annotations

import numpy as np

from lagnet.simulation.injection import StepPhysics
from lagnet.types import JointVector

LEAN = 0.6  # friction is taken at this part of the step: 0.5 rings for ever, 1.0 lags friction by half a step
NODES = np.concatenate([[0.0], np.geomspace(0.05, 1.0, 12)])
BRACKET = np.concatenate([-NODES[:0:-1], NODES])  # candidate changes of speed, dense around the middle
REFINED = np.linspace(0.0, 1.0, 9)
SWEEPS = 4
SETTLED, FINE = 1e-3, 1e-3  # relative and absolute (in units of `slow`) speed within which a guess counts as solved


def friction_torque(
    physics: StepPhysics, q: JointVector, free: JointVector, load: JointVector, ease: np.ndarray, guess: JointVector
) -> JointVector:
    """Torque r(v) of the joint effects at the speed v = free − ease r(v) that it leads to itself, shape (dof,).

    Args:
        physics: the joint effects.
        q, load: shape (dof,), positions [rad] and body torque [N m].
        free: shape (dof,), speeds that the step would lead to without these effects [rad/s].
        ease: shape (dof, dof), speed per torque over the step [rad/s per N m].
        guess: shape (dof,), torque of the step before [N m]; kept up with by one evaluation while nothing turns steep.
    """
    speed = free - ease @ guess
    added = physics.joint_torque(q, speed[None], load)[0]
    if np.all(np.diag(ease) * np.abs(added - guess) <= SETTLED * np.abs(speed) + FINE * physics.slow):
        return added
    added = np.zeros(free.size)
    for _ in range(SWEEPS if len(physics.sliding) > 1 else 1):
        for joint in physics.sliding:
            others = free - ease @ added + ease[:, joint] * added[joint]
            added[joint] = _one_joint(physics, q, others, load, ease[joint, joint], joint)
    return added


def _one_joint(
    physics: StepPhysics, q: JointVector, free: JointVector, load: JointVector, ease: float, joint: int
) -> float:
    """Torque of one joint at the speed it leads to: a bracket from scaled candidates, then a finer look inside it."""
    start = free[joint]
    explicit = _law(physics, q, free, load, joint, np.array([start]))[0]
    reach = max(2.0 * ease * abs(explicit), 1.5 * abs(start), 4.0 * physics.slow[joint])
    speeds = np.unique(np.concatenate([reach * BRACKET, start + 0.1 * reach * BRACKET]))
    torque = _law(physics, q, free, load, joint, speeds)
    for _ in range(2):
        k = _crossing(speeds - start + ease * torque)
        speeds = speeds[k] + REFINED * (speeds[k + 1] - speeds[k])
        torque = _law(physics, q, free, load, joint, speeds)
    gap = speeds - start + ease * torque
    k = _crossing(gap)
    share = float(np.clip(-gap[k] / max(gap[k + 1] - gap[k], 1e-300), 0.0, 1.0))
    return float(torque[k] + share * (torque[k + 1] - torque[k]))


def _crossing(gap: np.ndarray) -> int:
    """Index of the interval in which a function that is negative on the left first turns positive."""
    positive = np.flatnonzero(gap > 0)
    return int(np.clip((positive[0] if positive.size else gap.size) - 1, 0, gap.size - 2))


def _law(
    physics: StepPhysics, q: JointVector, free: JointVector, load: JointVector, joint: int, speeds: np.ndarray
) -> np.ndarray:
    rows = np.tile(free, (speeds.size, 1))
    rows[:, joint] = speeds
    return physics.joint_torque(q, rows, load)[:, joint]
