"""Causes of a size that matters on a small arm driven by position commands: the cases on which exports are measured."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from lagnet.models.corrected.servo_driven import ServoDrivenModel
from lagnet.rigid_body.kinematic_tree import kinematic_tree
from lagnet.rigid_body.robot import Robot
from lagnet.rollout.surface import HEIGHT, heights_of
from lagnet.servos.parameters import law_vector
from lagnet.types import JointVector, Samples, Trajectory

PLAIN: Mapping[str, float] = {"kp": 20.0, "kd": 1.5, "rotor": 0.1}
SERVO_CASES: Mapping[str, Mapping[str, float]] = {
    "gain_error": {"kp": 14.0, "kd": 2.5, "ki": 20.0},
    "viscous_friction": {"viscous": 3.0},
    "coulomb_friction": {"coulomb": 0.8},
    "position_bias": {"bias": 0.05},
    "command_delay": {"delay": 0.0434},
    "rotor_inertia": {"rotor": 0.4},
    "load_dependent_friction": {"load_driving": 0.4, "load_driven": 0.4},
    "directional_load_friction": {"load_driving": 0.5, "load_driven": 0.2},
    "quadratic_load_friction": {"load_squared": 0.2},
    "gear_friction": {"load_motor": 0.2, "load_driving": 0.2, "load_driven": 0.2},
    "static_friction": {"coulomb": 0.4, "static": 0.5},
    "stribeck_friction": {"coulomb": 0.4, "static": 0.5, "stribeck_speed": 0.15},
    "load_stribeck_friction": {
        "load_driving": 0.4,
        "load_driven": 0.4,
        "load_stribeck": 0.8,
        "stribeck_speed": 0.2,
    },
    "quadratic_drag": {"quadratic": 2.0},
    "dead_band": {"dead_band": 0.05},
    "duty_saturation": {"torque_limit": 2.1},
    "torque_saturation": {"saturation": 0.15},
    "torque_offset": {"offset": 1.0},
    "load_error": {"load_gain": 1.6},
    "joint_spring": {"spring": 8.0, "spring_rest": 0.3},
    "joint_elasticity": {"stiffness": 20.0, "twist_damping": 0.5},
    "backlash": {"gap": 0.06},
}
"""Parameters of one joint's law; `payload` is in the bodies, and a surface lies where the arm comes low."""

SURFACE = np.array([2.0, 0.0, 0.0, -0.2, 0.0, 3e4, 0.2])  # of the last body
LOW = 0.2  # share of the motion that would be below the surface
JOINT = 1
REST = 1.0  # [s] over which commands set in
OMEGA, REACH, JUMP = np.array([1.1, 1.7, 2.3]), np.array([0.6, 0.5, 0.7]), 0.2  # [rad/s], [rad], [rad]
RATE = 100.0  # [Hz] of commands


def commands(seconds: float) -> tuple[Samples, Trajectory]:
    """Times and commands of three joints: sines that set in, and a jump at the second one halfway."""
    time = np.arange(round(seconds * RATE)) / RATE
    sent = REACH * np.sin(time[:, None] * OMEGA) * np.minimum(time / REST, 1.0)[:, None]
    sent[time > seconds / 2.0, JOINT] += JUMP
    return time, sent


def plain_model(robot: Robot) -> ServoDrivenModel:
    """The arm with plain servos."""
    return ServoDrivenModel(robot, np.tile(law_vector(**PLAIN), (robot.n_dof, 1)), (True,) * robot.n_dof)


def servo_case(robot: Robot, name: str, moved: Trajectory) -> ServoDrivenModel:
    """The arm with one cause; moved: how it moves without."""
    plain = plain_model(robot)
    if name == "surface_contact":
        surface = SURFACE.copy()
        surface[HEIGHT] = np.quantile(heights_of(kinematic_tree(robot), surface, moved), LOW)
        return ServoDrivenModel(robot, plain.laws, plain.scale_is_set, surface=surface)
    laws = plain.laws.copy()
    laws[JOINT] = law_vector(**{**PLAIN, **SERVO_CASES[name]})
    return ServoDrivenModel(robot, laws, plain.scale_is_set)


def start_of(robot: Robot) -> JointVector:
    """Where the arm starts, at rest."""
    return np.zeros(robot.n_dof)
