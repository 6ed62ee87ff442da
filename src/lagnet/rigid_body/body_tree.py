"""The bodies of an arm as plain numbers: what an exporter writes, and what a page draws."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from lagnet.rigid_body.descriptions.writing import axis


@dataclass(frozen=True, eq=False)
class TreeBody:
    """One moving body and the joint that carries it.

    Args:
        name: of the body.
        joint: name of its joint.
        kind: 'revolute', 'continuous' or 'prismatic'.
        parent: index of the body that it hangs on, -1 for the base.
        position: shape (3,), origin of the joint's frame in the parent's frame, joint at zero [m].
        rotation: shape (3, 3), axes of the joint's frame as columns in the parent's frame, joint at zero.
        axis: shape (3,), unit axis of the joint in its own frame.
        mass: [kg].
        centre: shape (3,), centre of mass in the joint's frame [m].
        inertia: shape (3, 3), about the centre of mass, in the axes of the joint's frame [kg m²].
        lower, upper: limits of position [rad or m], infinite where there are none.
        velocity_limit, effort_limit: infinite where there are none.
    """

    name: str
    joint: str
    kind: str
    parent: int
    position: np.ndarray
    rotation: np.ndarray
    axis: np.ndarray
    mass: float
    centre: np.ndarray
    inertia: np.ndarray
    lower: float
    upper: float
    velocity_limit: float
    effort_limit: float

    @property
    def turns(self) -> bool:
        """Whether the joint turns; else it slides."""
        return self.kind != "prismatic"


def tree_of(description: Any, robot: Any) -> tuple[TreeBody, ...]:
    """Every moving body from the base outwards.

    Args:
        description: what the arm was read from, with its present model.
        robot: the arm, for names and limits.
    """
    model = description.model
    return tuple(_body(model, robot, i) for i in range(1, model.njoints))


def _body(model: Any, robot: Any, i: int) -> TreeBody:
    place, inertia, k = model.jointPlacements[i], model.inertias[i], i - 1
    return TreeBody(
        robot.links[k],
        robot.joints[k],
        robot.joint_types[k],
        robot.parents[k],
        np.array(place.translation),
        np.array(place.rotation),
        axis(model, i),
        float(inertia.mass),
        np.array(inertia.lever),
        np.array(inertia.inertia),
        float(robot.position_lower[k]),
        float(robot.position_upper[k]),
        float(robot.velocity_limit[k]),
        float(robot.effort_limit[k]),
    )
