"""What commands to record to tell servo parameters apart: trial commands of one joint, simulated with either value."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.comparison.differences import Difference, short
from lagnet.models.corrected.servo_driven import ServoDrivenModel
from lagnet.servos.parameters import INDEX

SECONDS, PERIOD = 6.0, 0.01
LARGE, SMALL = 0.4, 0.1  # [rad or m] about the middle of the recorded motion; at most so much of the joint's range
RANGE = 0.2
TRIALS = {
    "turn it slowly both ways": lambda t: LARGE * _triangle(t / 6.0),
    "swing it at 1.5 Hz": lambda t: SMALL * np.sin(2 * np.pi * 1.5 * t),
    "swing it at 4 Hz": lambda t: SMALL * np.sin(2 * np.pi * 4.0 * t),
    "command large steps": lambda t: LARGE * np.sign(np.sin(2 * np.pi * t / 2.0)),
    "command small steps": lambda t: SMALL * np.sign(np.sin(2 * np.pi * t / 2.0)),
}


def _triangle(turns: np.ndarray) -> np.ndarray:
    return 2.0 / np.pi * np.arcsin(np.sin(2 * np.pi * turns))


@dataclass(frozen=True)
class MotionAdvice:
    """One way to tell two values of a servo parameter apart.

    Args:
        parameter: its name with the joint's.
        motion: what to command.
        joint: the joint.
        difference: root mean square by which the motions with either value differ [rad or m].
        noise: error that the best set leaves on that joint now [rad or m].
        in_proportion: the parameter is seen, but not beside others that act alike.
    """

    parameter: str
    motion: str
    joint: str
    difference: float
    noise: float
    in_proportion: bool

    @property
    def is_enough(self) -> bool:
        """Whether the difference stands out of what the best set leaves."""
        return self.difference > self.noise

    def words(self) -> str:
        """One sentence."""
        by = f"the values differ by {self.difference:.2g} rad, {self.noise:.2g} rad are unexplained"
        if not self.is_enough:
            return f"{short(self.parameter)}: at most ({self.motion}) {by}: find that first (lagnet diagnose)"
        if self.in_proportion:
            return (
                f"{short(self.parameter)}: {self.motion} with a known mass on the arm, or with torque or current "
                f"recorded: motion alone gives it in proportion to others; alone {by}"
            )
        return f"{short(self.parameter)}: {self.motion}: {by}"


def motion_advice(
    model: ServoDrivenModel,
    joint: int,
    laws: np.ndarray,
    differences: Sequence[Difference],
    left: float,
    recorded: np.ndarray,
) -> list[MotionAdvice]:
    """For each difference of a joint that stays open, the trial command that shows it best.

    Args:
        model: the best set.
        joint: index.
        laws: shape (sets, len(LAW)), of all sets at this joint.
        differences: what the recordings say of them.
        left: error that the best set leaves [rad or m].
        recorded: shape (n,), positions of the joint.
    """
    out = []
    for entry in (d for d in differences if not d.resolved):
        k = INDEX[entry.parameter.split("(")[0]]
        ends = float(laws[:, k].min()), float(laws[:, k].max())
        apart = {name: _apart(model, joint, k, ends, trial, recorded) for name, trial in TRIALS.items()}
        motion = max(apart, key=apart.__getitem__)
        proportion = not np.isfinite(entry.error)
        out.append(MotionAdvice(entry.parameter, motion, model.joints[joint], apart[motion], left, proportion))
    return out


def _apart(
    model: ServoDrivenModel, joint: int, k: int, ends: tuple[float, float], trial, recorded: np.ndarray
) -> float:
    """Root mean square between the motions with either value; a joint that diverges counts by its range."""
    time = np.arange(round(SECONDS / PERIOD)) * PERIOD
    room = RANGE * max(float(np.ptp(recorded)), SMALL) if model.joint_types[joint] == "prismatic" else np.inf
    wave = trial(time) * min(1.0, room / LARGE)
    pose = np.clip(np.zeros(model.n_dof), model.position_lower, model.position_upper)
    pose[joint] = float(np.median(recorded))
    command = np.tile(pose, (len(time), 1))
    command[:, joint] += wave
    moved = []
    for value in ends:
        laws = model.laws.copy()
        laws[joint, k] = value
        changed = replace(model, laws=laws)
        moved.append(changed.rollout(command, time, command[0])[:, joint])
    return float(np.sqrt(np.mean(np.clip(moved[1] - moved[0], -np.pi, np.pi) ** 2)))
