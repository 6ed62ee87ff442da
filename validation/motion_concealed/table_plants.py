"""Arms over a table: a point of the arm touches it in a part of the motion, with dry friction hidden in every other."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lagnet.rigid_body.kinematic_tree import kinematic_tree
from lagnet.rigid_body.robot import load_description
from lagnet.rollout.surface import heights_of
from lagnet.servos.servo_file import servo_of_values
from validation.motion_concealed.commands import commands
from validation.motion_concealed.mujoco_plant import MujocoPlant, Table
from validation.motion_concealed.plants import SAMPLE, Plant, record
from validation.motion_concealed.robots import SERVO, servo_law, write_mjcf

POINTS = {"arm6": (5, (0.0, 0.02, 0.09)), "so101": (4, (-0.0079, 0.0, -0.098))}
RISE = (0.15, 0.5)  # of the way from the lowest commanded pose to the median one
FRICTION = (0.03, 0.15)  # [N m] of every joint, for kp = 8 N m/rad


@dataclass(frozen=True)
class TableCase:
    """An arm, the table that it hides, None for one without, and hidden dry friction of every joint [N m]."""

    plant: Plant
    table: Table | None
    friction: float


def plant_over_table(seed: int, index: int, kind: str, with_table: bool, seconds: float, folder: Path) -> TableCase:
    """One plant of a kind; the table lies between the lowest commanded pose and the median one.

    Args:
        seed, index: of all that is drawn; friction is hidden in every other pair of plants, so of every kind.
        kind: arm6 or so101.
        with_table: whether there is one.
        seconds: of each of three recordings.
        folder: for the nominal model's file.
    """
    rng = np.random.default_rng([seed, index])
    law, robot = servo_law(kind), load_description(write_mjcf(kind, folder))
    joint, point = POINTS[kind]
    friction = rng.uniform(*FRICTION) * law["kp"] / SERVO["kp"] * (index // 2 % 2)
    seeds, share = [int(s) for s in rng.integers(1 << 30, size=3)], rng.uniform(*RISE)
    time = np.arange(0.0, seconds, SAMPLE)
    asked = np.concatenate([commands(np.random.default_rng(s), time, robot) for s in seeds])
    heights = heights_of(kinematic_tree(robot), np.array([joint, *point, 0.0, 1.0, 0.0]), asked)
    lowest, median = float(heights.min()), float(np.median(heights))
    table = Table(lowest + share * (median - lowest), joint, point) if with_table else None
    real = law | {"coulomb": law["coulomb"] + friction}
    recordings = tuple(
        record(MujocoPlant(robot, real, None, table), robot, None, seconds, s, i) for i, s in enumerate(seeds)
    )
    servo = servo_of_values({name: dict(law) for name in robot.joints}, robot.joints, robot.armature, "file")
    return TableCase(Plant(f"{kind}_{index}", robot, servo, recordings, None), table, round(float(friction), 4))
