"""Rollouts of a motor and a link that a spring or a play joins, against closed forms and against each other."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.rigid_body.kinematic_tree import KinematicTree
from lagnet.rollout.one_joint import JointSeries, Windows, roll_out
from lagnet.rollout.whole_arm import roll_out_arm
from lagnet.servos.command_delay import command_integral
from lagnet.servos.parameters import law_vector

TIME = np.arange(0.0, 5.0, 0.02)
STEP = 0.001  # [s]
SECOND_ORDER = 1e-4  # [rad] (ω h)² of a step of 1 ms at 10 rad/s, over a few periods
SAME = 1e-10  # [rad] two compiled forms of one equation
STEPS = np.random.default_rng(0).uniform(-1.0, 1.0, 10)[(TIME / 0.5).astype(int)]
YIELDING = [
    {"stiffness": 60.0, "twist_damping": 0.5},
    {"gap": 0.05},
    {"gap": 0.05, "stiffness": 60.0, "twist_damping": 0.5},
]


def rolled(command: np.ndarray, q0: float = 0.0, load: float = 0.0, **law: float) -> np.ndarray:
    """One joint whose link has 1 kg m² and a constant load."""
    ones, zeros = np.ones_like(TIME), np.zeros_like(TIME)
    rows = (TIME, command, command_integral(TIME, command), ones * q0, ones, ones * load, zeros, ones, ones, ones)
    windows = Windows(np.array([0]), np.array([TIME.size - 1]), np.array([0]), np.zeros(1))
    return roll_out(law_vector(**law), JointSeries(*rows), windows, STEP)[0]


def rolled_as_arm(command: np.ndarray, **law: float) -> np.ndarray:
    """The same without load by the rollout of a whole arm."""
    body = np.array([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 1.0])[None]
    still, axis = np.zeros((1, 3)), np.array([[0.0, 1.0, 0.0]])
    tree = KinematicTree(np.array([-1]), np.eye(3)[None], still, axis, np.array([False]), body, np.zeros(1), still[0])
    return roll_out_arm(tree, law_vector(**law)[None], TIME, command[:, None], np.zeros(1), step=STEP)[:, 0]


def test_two_masses_swing_in_their_two_modes():
    found = rolled(np.zeros_like(TIME), q0=1.0, kp=25.0, rotor=1.0, stiffness=40.0)
    squares, shapes = np.linalg.eigh(np.array([[65.0, -40.0], [-40.0, 40.0]]))
    modes = (shapes.T @ np.ones(2))[:, None] * np.cos(np.sqrt(squares)[:, None] * TIME)
    assert np.abs(found - (shapes @ modes)[0]).max() < SECOND_ORDER


@pytest.mark.parametrize("side", [0.0, 1.0])
@pytest.mark.parametrize("law", YIELDING)
def test_the_whole_arm_and_one_joint_agree(law, side):
    servo = {"kp": 20.0, "kd": 3.0, "rotor": 0.5, "coulomb": 0.5, "encoder_side": side} | law
    assert np.abs(rolled(STEPS, **servo) - rolled_as_arm(STEPS, **servo)).max() < SAME


@pytest.mark.parametrize("side", [0.0, 1.0])
@pytest.mark.parametrize(("law", "near"), [({"stiffness": 1e5, "twist_damping": 30.0}, 5e-4), ({"gap": 1e-7}, 1e-6)])
def test_a_stiff_transmission_moves_as_a_rigid_joint(law, near, side):
    servo = {"kp": 20.0, "kd": 3.0, "rotor": 0.5, "coulomb": 0.5}
    assert np.abs(rolled(STEPS, **servo) - rolled(STEPS, **servo, **law, encoder_side=side)).max() < near


def test_a_load_bends_the_spring_behind_a_motor_that_measures_itself():
    servo = {"kp": 20.0, "kd": 9.0, "rotor": 1.0, "stiffness": 50.0, "twist_damping": 5.0}
    at_motor, at_link = (rolled(np.zeros_like(TIME), load=1.0, **servo, encoder_side=s)[-1] for s in (0.0, 1.0))
    assert abs(at_motor + 1.0 / 20.0) < SECOND_ORDER  # the motor gives kp e = load, its spring's bend is not seen
    assert abs(at_link + 1.0 / 20.0) < SECOND_ORDER  # and the drive itself makes the link's error the same


def test_inside_its_play_a_motor_turns_without_its_link():
    push = np.where(TIME < 1.0, 0.0, 0.04)
    servo = {"kp": 20.0, "kd": 9.0, "rotor": 1.0, "gap": 0.05}
    motor = rolled(push, **servo, encoder_side=0.0)
    assert abs(motor[-1] - 0.04) < SECOND_ORDER
    assert np.ptp(rolled(push, **servo, encoder_side=1.0)[TIME < 1.0]) == 0.0


def test_a_motor_takes_its_link_along_beyond_the_play():
    push = np.where(TIME < 1.0, 0.0, 0.5)
    link = rolled(push, kp=20.0, kd=9.0, rotor=1.0, gap=0.05, viscous=20.0, encoder_side=1.0)
    assert link[-1] > 0.1
    assert np.all(np.diff(link) >= -SAME)
