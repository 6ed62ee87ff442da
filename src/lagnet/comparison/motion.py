"""Which of several sets of bodies and servos explains recorded motion under recorded commands, joint by joint.

Every joint is rolled out by its commands with each set's own servo, a few seconds from a measured state, while the
others move as measured; the errors of whole rollouts are the blocks of the bootstrap.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from lagnet.comparison.compare import check_models
from lagnet.comparison.differences import Difference
from lagnet.comparison.joints import JointComparison, bootstrap_weights, judge_joint
from lagnet.comparison.motion_advice import MotionAdvice, motion_advice
from lagnet.comparison.motion_resolution import joint_differences
from lagnet.diagnosis.motion.joint.fitting import JointData
from lagnet.diagnosis.motion.problem import MotionProblem, pose_motion_problem
from lagnet.errors import LagnetError
from lagnet.models.corrected.servo_driven import ServoDrivenModel
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.kinematic_tree import kinematic_tree
from lagnet.rigid_body.mjcf_actuators import position_actuators
from lagnet.rigid_body.robot import Robot
from lagnet.servos.nominal import NominalServo
from lagnet.servos.servo_file import servo_of_values

FEWEST = 10  # rollouts that an interval rests on
RANGES = 10.0  # of motion: where an error is counted no further, of rollouts that diverge


@dataclass(frozen=True, eq=False)
class MotionComparison:
    """What recorded motion says of several sets.

    Args:
        names: of the sets.
        joints: one comparison for each joint that moves.
        still: joints that do not.
        blocks: how many rollouts the intervals rest on.
        length: of a rollout [s].
        differences: parameters in which sets differ, those that stand out most first.
        to_record: what would decide those that stay open.
        reason: always "": the sets have servos, whose parameters are compared.
    """

    names: tuple[str, ...]
    joints: tuple[JointComparison, ...]
    still: tuple[str, ...]
    blocks: int
    length: float
    differences: tuple[Difference, ...]
    to_record: tuple[MotionAdvice, ...]
    reason: str = ""


def servo_driven(model: Any, name: str, servo: NominalServo | None = None) -> ServoDrivenModel:
    """A set with its servos: those that are given, else those of its MJCF.

    Raises:
        LagnetError: a joint without a position gain, or a model that has no bodies.
    """
    if isinstance(model, ServoDrivenModel):
        return model
    if not isinstance(model, Robot):
        raise LagnetError("the recordings hold commands alone, and this model has no servos", where=name)
    if servo is None:
        given, notes = position_actuators(model)
        servo = servo_of_values(given, model.joints, model.armature, "mjcf", notes)
    without = [joint for joint, known in zip(model.joints, servo.known, strict=True) if not known]
    if without:
        raise LagnetError(
            f"gives no position gain for {', '.join(without)}; the recordings hold commands alone",
            where=name,
            next_step="give its servos with --actuator SERVO.toml, or an MJCF with position actuators",
        )
    return ServoDrivenModel(model, servo.laws, (True,) * model.n_dof)


def compare_motion(
    models: Sequence[ServoDrivenModel],
    names: Sequence[str],
    recordings: Sequence[Recording],
    seed: int = 0,
    gains: Sequence[float] | None = None,
) -> MotionComparison:
    """Hold several sets of bodies and servos against recordings of commands and positions.

    Args:
        models: with their servos, see `servo_driven`.
        names: what they are called.
        recordings: with commands.
        seed: of the bootstrap.
        gains: of the controller in each recording over those of the sets' servos; None: 1 in all.

    Raises:
        LagnetError: fewer than two models, one of them twice, other joints, no commands, too little motion, or gains
            that are not one positive number a recording.
    """
    check_models(models, names)
    problems = [pose_motion_problem(recordings, kinematic_tree(m.nominal), gains) for m in models]
    joints, differences, to_record, length, blocks = [], [], [], 0.0, 0
    for j in _moving(problems[0]):
        windows = problems[0].windows(j)
        step = min(problems[0].step, 0.004)
        data = [JointData(p.series[j], windows, step) for p in problems]
        laws = np.array([m.laws[j] for m in models])
        errors = np.array([d.errors(law) for d, law in zip(data, laws, strict=True)])
        span, blocks = (
            np.subtract(data[0].series.time[windows.last], data[0].series.time[windows.first]),
            len(windows.first),
        )
        if blocks < FEWEST:
            raise LagnetError(
                f"{blocks} rollouts are too few for an interval", next_step=f"give {FEWEST * 2} s of motion"
            )
        length = float(np.median(span))
        found = _judge(models[0].joints[j], errors, data[0], bootstrap_weights(blocks, seed))
        joints.append(found)
        best = found.best
        own = joint_differences(models[0].joints[j], data[best], laws, best)
        differences += own
        left = float(np.sqrt(np.mean(errors[best] ** 2)))
        to_record += motion_advice(models[best], j, laws, own, left, data[best].series.q)
    if not joints:
        raise LagnetError("no joint moves in these recordings", next_step="give recordings of motion")
    moved = {joint.joint for joint in joints}
    still = tuple(name for name in models[0].joints if name not in moved)
    differences.sort(key=lambda d: -d.errors_apart)
    to_record.sort(key=lambda a: -a.difference / max(a.noise, 1e-300))
    return MotionComparison(tuple(names), tuple(joints), still, blocks, length, tuple(differences), tuple(to_record))


def _moving(problem: MotionProblem) -> list[int]:
    """Joints that change their position more than a few times."""
    return [j for j, s in enumerate(problem.series) if np.ptp(s.q) > 1e-6 and np.sum(np.abs(np.diff(s.q)) > 1e-9) > 3]


def _judge(name: str, errors: np.ndarray, data: JointData, weights: np.ndarray) -> JointComparison:
    """nMSE of the sets with bootstrap over rollouts; errors of shape (sets, n)."""
    reach = RANGES * float(np.ptp(data.series.q))
    squares = np.clip(errors, -reach, reach) ** 2
    scatter = (data.series.q - data.series.q.mean()) ** 2
    rows = list(zip(data.windows.first, data.windows.last, strict=True))
    power = np.array([squares[:, a + 1 : b + 1].sum(axis=1) for a, b in rows])
    total = np.array([scatter[a + 1 : b + 1].sum() for a, b in rows])
    draws = (weights @ power) / np.maximum(weights @ total, 1e-300)[:, None]
    return judge_joint(name, power.sum(axis=0) / max(float(total.sum()), 1e-300), draws)
