"""π + Δπ: the inertial parameters and the gravity of a robot with payload, link changes and tilt written into it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol, runtime_checkable

import numpy as np

from lagnet.effects.catalogue import effect_named
from lagnet.effects.inertia.gravity_tilt import GravityTilt
from lagnet.errors import EffectError
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.rigid_body.inertia import is_physically_consistent
from lagnet.types import InverseDynamics, RobotModel, is_robot_model

CHANGES_OF_BODIES = {"payload", "link_inertia", "gravity_tilt"}  # effects with a place in a robot description


@runtime_checkable
class Correction(Protocol):
    """A model that can write what it changes into the bodies of its robot."""

    def bodies(self) -> RobotModel:
        """The robot with the changes."""
        ...


def apply_to_bodies(nominal: InverseDynamics | Any, effects: Sequence[NamedEffect]) -> RobotModel:
    """A robot with payload, link changes and tilt of the base in its description.

    Raises:
        EffectError: the nominal model has no bodies.
    """
    source = nominal.bodies() if isinstance(nominal, Correction) else nominal
    if not is_robot_model(source):
        raise EffectError("the nominal model has no bodies to write into")
    robot = source
    for effect in effects:
        law = effect_named(effect.effect)
        if isinstance(law, GravityTilt) and effect.interval is None:
            robot = robot.with_gravity(law.gravity_of(robot.gravity, effect.values))
    return robot.with_inertial_parameters(changed_parameters(source, effects))


def changed_parameters(robot: RobotModel, effects: Sequence[NamedEffect]) -> np.ndarray:
    """π + Δπ of every link with payload and link changes, shape (dof, 10)."""
    own = robot.inertial_parameters()
    return own + named_body_change(len(own), effects)


def named_body_change(n_dof: int, effects: Sequence[NamedEffect]) -> np.ndarray:
    """Δπ that payload and link changes add to the ten inertial parameters of every link, shape (dof, 10)."""
    change = np.zeros((n_dof, 10))
    for effect in effects:
        if effect_named(effect.effect).is_body and effect.interval is None:
            change[-1 if effect.joint is None else effect.joint] += effect.body_parameters
    return change


def are_consistent(robot: RobotModel, effects: Sequence[NamedEffect], more: np.ndarray | None) -> bool:
    """Whether some distribution of mass has every changed body, so that a robot file may hold it.

    Args:
        robot: the nominal robot.
        effects: payload and link changes among them are counted.
        more: shape (dof, 10), further changes of the parameters; None: none.
    """
    own = robot.inertial_parameters()
    bodies = changed_parameters(robot, effects)
    if more is not None:
        bodies = bodies + more
    return bool(np.all(is_physically_consistent(bodies[(bodies != own).any(axis=1)])))
