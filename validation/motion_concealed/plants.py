"""Position-controlled arms that MuJoCo or PyBullet moves, with at most one cause hidden in servo, joint or bodies."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from lagnet.recordings.recording import Recording
from lagnet.rigid_body.robot import load_description
from lagnet.servos.nominal import NominalServo
from lagnet.servos.servo_file import servo_of_values
from validation.motion_concealed.bullet_plant import BulletPlant
from validation.motion_concealed.causes import ENCODER, LISTED, SIDES, UNLISTED, YIELDING, Cause, draw_cause
from validation.motion_concealed.commands import commands
from validation.motion_concealed.mujoco_plant import STEP, MujocoPlant
from validation.motion_concealed.robots import SERVO, servo_law, write_mjcf, write_urdf

__all__ = ["ENCODER", "LISTED", "SERVO", "UNLISTED", "Cause", "Plant", "plant"]

SAMPLE = 0.02  # [s] of the recording
SETTLE = 1.0  # [s] at the first command before a recording begins
BULLET = "_bullet"  # ending of a kind that PyBullet moves
JOINTS = {"pendulum": (0,), "leg": (0, 1), "arm6": (1, 2, 4), "so101": (1, 2)}  # that carry a load


@dataclass(frozen=True)
class Plant:
    """A nominal robot with its servos, recordings of the real one, and what that hides."""

    name: str
    robot: Any
    servo: NominalServo
    recordings: tuple[Recording, ...]
    cause: Cause | None


def plant(seed: int, index: int, kind: str, effect: str | None, seconds: float, folder: Path) -> Plant:
    """One plant of a kind that hides an effect, or nothing.

    Args:
        seed, index: of all that is drawn; a motor apart has its encoder on its own side where the index is even.
        kind: pendulum, leg, arm6 or so101, with `_bullet` where PyBullet moves it.
        effect: a key of LISTED or UNLISTED.
        seconds: of each of three recordings.
        folder: for the nominal model's file.
    """
    rng = np.random.default_rng([seed, index])
    body = kind.removesuffix(BULLET)
    law = servo_law(body)
    by_bullet = kind != body
    robot = load_description(write_urdf(body, folder / f"{kind}.urdf") if by_bullet else write_mjcf(body, folder))
    cause = None
    if effect is not None:
        joint = int(rng.choice(JOINTS[body]))
        cause = draw_cause(rng, effect, joint, law["kp"] / SERVO["kp"], SIDES[index % 2])
    recordings = []
    for i in range(3):
        real = BulletPlant(robot, body, law, cause, folder) if by_bullet else MujocoPlant(robot, law, cause)
        recordings.append(record(real, robot, cause, seconds, int(rng.integers(1 << 30)), i))
        if isinstance(real, BulletPlant):
            real.close()
    given = {name: dict(law) for name in robot.joints}
    for joint, name in enumerate(robot.joints):
        if by_bullet and not (cause is not None and cause.effect in YIELDING and cause.joint == joint):
            given[name]["rotor"] = 0.0  # PyBullet has none
    servo = servo_of_values(given, robot.joints, robot.armature, "file")
    return Plant(f"{kind}_{index}", robot, servo, tuple(recordings), cause)


def record(
    real: MujocoPlant | BulletPlant, robot: Any, cause: Cause | None, seconds: float, seed: int, index: int
) -> Recording:
    """What encoders and commands of a plant show over so many seconds; seed: of the commands, index: of the name."""
    rng, time = np.random.default_rng(seed), np.arange(0.0, seconds, SAMPLE)
    command, q = commands(rng, time, robot), np.empty((time.size, robot.n_dof))
    late = round(cause.value / STEP) if cause is not None and cause.effect == "command_delay" else 0
    per = round(SAMPLE / STEP)
    real.start(command[0])
    for _ in range(round(SETTLE / STEP)):
        real.advance(command[0], 0.0, 0.0)
    for k in range(time.size):
        q[k] = real.seen()
        for i in range(per):
            asked = _held(command, k * per + i, per)
            if late and cause is not None:
                asked[cause.joint] = _held(command, k * per + i - late, per)[cause.joint]
            real.advance(asked, k / time.size, time[k])
    return Recording(time, ENCODER * np.round(q / ENCODER), None, robot.joints, command=command, path=f"run_{index}")


def _held(command: np.ndarray, step: int, per: int) -> np.ndarray:
    """The command at a step of the engine; one that changes there has half of the push that the step gives, (dof,)."""
    before, after = command[max(0, step - 1) // per], command[max(0, step) // per]
    return 0.5 * (before + after)
