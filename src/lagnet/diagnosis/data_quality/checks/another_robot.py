"""Log of another robot: a named robot of as many joints whose misfit is far smaller."""

from __future__ import annotations

from collections.abc import Iterator

from lagnet.diagnosis.data_quality.check import Evidence, Reading, ReadingCheck
from lagnet.diagnosis.data_quality.misfit import misfit_of, misfits_of
from lagnet.errors import RobotError
from lagnet.rigid_body.descriptions.named_robots import named_robots
from lagnet.rigid_body.robot import Robot, load_description

RARE = 1.5  # prior of another robot: a wrong column is more common


class AnotherRobot(ReadingCheck):
    """Recordings that fit one of the robots that come by name, and not the one that was given."""

    name = "another_robot"
    title = "the recordings are of another robot"
    last = True

    def readings(self, evidence: Evidence) -> Iterator[Reading]:
        found = sorted(
            (misfit_of(robot, evidence.few), name, robot)
            for name, robot in same_size(evidence.model.n_dof)
            if getattr(evidence.model, "sha256", "") != robot.sha256
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
