"""Log of another robot: a named robot of as many joints and other kinematics whose misfit is far smaller.

A rough model of the arm that was recorded, its masses guessed, placeholders or missing, fits worse than a named robot
that has them. It is what a diagnosis is asked to mend.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lagnet.diagnosis.data_quality.check import Evidence, Reading, ReadingCheck
from lagnet.diagnosis.data_quality.misfit import misfit_of, misfits_of
from lagnet.diagnosis.data_quality.samples import Samples
from lagnet.errors import RobotError
from lagnet.rigid_body.descriptions.named_robots import named_robots
from lagnet.rigid_body.inertia import parameters_of_body
from lagnet.rigid_body.robot import Robot, load_description
from lagnet.types import knows_masses

RARE = 1.5  # prior of another robot: a wrong column is more common
SAME = 0.01  # of the torque of equal bodies, by which that of two files of one arm may differ
BALL = parameters_of_body(1.0, np.array([0.05, 0.05, 0.05]), 0.01 * np.eye(3))


class AnotherRobot(ReadingCheck):
    """Recordings that fit one of the robots that come by name, and not the one that was given."""

    name = "another_robot"
    title = "the recordings are of another robot"
    last = True

    def readings(self, evidence: Evidence) -> Iterator[Reading]:
        if not knows_masses(evidence.model):
            return
        found = sorted(
            (misfit_of(robot, evidence.few), name, robot)
            for name, robot in same_size(evidence.model.n_dof)
            if not same_kinematics(evidence.model, robot, evidence.few)
        )
        for _, name, robot in found[:2]:
            yield Reading(
                self.name,
                "",
                misfits_of(robot, evidence.many),
                f"the recordings fit the robot {name}, and not {getattr(evidence.model, 'source', '') or 'the model'}",
                f"give --robot {name}, or the file that describes the arm that was recorded",
                RARE,
            )


def same_size(n_dof: int) -> Iterator[tuple[str, Robot]]:
    """The named robots with this number of joints."""
    for name in named_robots():
        try:
            robot = load_description(name)
        except RobotError:
            continue
        if robot.n_dof == n_dof:
            yield name, robot


def same_kinematics(model: object, robot: Robot, samples: Samples) -> bool:
    """Whether equal bodies on all links need the same torque of both along a motion, to a hundredth."""
    if not isinstance(model, Robot):
        return False
    ours, theirs = (
        arm.with_inertial_parameters(np.tile(BALL, (arm.n_dof, 1))).inverse_dynamics(samples.q, samples.v, samples.a)
        for arm in (model, robot)
    )
    return bool(np.sum((ours - theirs) ** 2) <= SAME**2 * np.sum(ours**2))
