"""The corrected model itself as an arm that takes commanded torques: the reference for every engine."""

from __future__ import annotations

import numpy as np

from lagnet.simulators.corrected_arm.arm_physics import ArmPhysics
from lagnet.simulators.corrected_arm.forward_motion import ForwardMotion
from lagnet.types import JointVector


class DrivenArm:
    """Forward motion behind the drives: scale, zero, limit and clock between a command and its joint.

    Args:
        arm: its physics.
        step: [s], of the integration.
        q, v: shape (dof,), where it starts [rad, rad/s].
    """

    def __init__(self, arm: ArmPhysics, step: float, q: JointVector, v: JointVector):
        self._arm, self._dt = arm, step
        self._motion = ForwardMotion(arm, step, q, v)
        self._hold = [round(d.hold / step) for d in arm.drives]
        self._plain = all(d.is_plain for d in arm.drives)
        self._past: list[JointVector] = []

    def read(self) -> tuple[JointVector, JointVector]:
        """Encoder positions and speeds."""
        now = self._motion.instant
        return now.q, now.v

    def advance(self, torque: JointVector, seconds: float) -> None:
        """Let time pass under a commanded torque."""
        if self._plain:
            self._motion.advance(torque, round(seconds / self._dt))
            return
        for _ in range(round(seconds / self._dt)):
            self._past.append(np.asarray(torque, dtype=float))
            del self._past[: max(0, len(self._past) - max(self._hold) - 1)]
            at = [
                d.at_joint(self._held(j, h)) for j, (d, h) in enumerate(zip(self._arm.drives, self._hold, strict=True))
            ]
            self._motion.advance(np.array(at))

    def _held(self, joint: int, steps: int) -> float:
        """The command of some steps ago; before the first one, none."""
        return self._past[-1 - steps][joint] if len(self._past) > steps else 0.0
