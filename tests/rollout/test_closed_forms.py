"""Rollouts of one joint against motions that have a closed form."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.rigid_body.kinematic_tree import KinematicTree
from lagnet.rollout.one_joint import JointSeries, Windows, roll_out
from lagnet.rollout.whole_arm import roll_out_arm
from lagnet.servos.command_delay import command_integral
from lagnet.servos.parameters import law_vector

TIME = np.arange(0.0, 5.0, 0.02)
FINE = 0.001  # [s]
SECOND_ORDER = 1e-4  # [rad] (ω h)² of a step of 1 ms at 5 rad/s, over a few periods
AT_STOPS = 1e-3  # [rad] the step in which an oscillator stops is not resolved


def series(command: np.ndarray, q0: float = 0.0, load: float = 0.0) -> JointSeries:
    ones, zeros = np.ones_like(TIME), np.zeros_like(TIME)
    rows = (TIME, command, command_integral(TIME, command), ones * q0, ones, ones * load, zeros, ones, ones, ones)
    return JointSeries(*rows)


def rolled(command: np.ndarray, q0: float = 0.0, load: float = 0.0, **law: float) -> np.ndarray:
    windows = Windows(np.array([0]), np.array([len(TIME) - 1]), np.array([0]), np.zeros(1))
    return roll_out(law_vector(**law), series(command, q0, load), windows, FINE)[0]


def swinging_alone(law: np.ndarray) -> np.ndarray:
    """One joint of 1 kg m² without gravity, let go at 1 rad, by the rollout of a whole arm."""
    body = np.array([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 1.0])
    still = np.zeros((1, 3))
    axis, inertia = np.array([[0.0, 1.0, 0.0]]), body[None]
    tree = KinematicTree(
        np.array([-1]), np.eye(3)[None], still, axis, np.array([False]), inertia, np.zeros(1), still[0]
    )
    return roll_out_arm(tree, law[None], TIME, np.zeros((TIME.size, 1)), np.ones(1), step=FINE)[:, 0]


def test_a_spring_swings_as_a_cosine():
    assert np.abs(rolled(np.zeros_like(TIME), 1.0, kp=25.0) - np.cos(5.0 * TIME)).max() < SECOND_ORDER


def test_a_joint_spring_swings_about_its_rest():
    q = rolled(np.zeros_like(TIME), 1.0, kp=1e-6, spring=25.0, spring_rest=0.4)
    assert np.abs(q - 0.4 - 0.6 * np.cos(5.0 * TIME)).max() < SECOND_ORDER


def test_a_damped_spring_decays_by_its_closed_form():
    rate = np.sqrt(25.0 - 1.0)
    exact = np.exp(-TIME) * (np.cos(rate * TIME) + np.sin(rate * TIME) / rate)
    assert np.abs(rolled(np.zeros_like(TIME), 1.0, kp=25.0, viscous=2.0) - exact).max() < SECOND_ORDER


def test_dry_friction_takes_the_same_from_every_swing_and_then_holds():
    friction, half = 2.0 / 25.0, np.pi / 5.0
    swing = np.minimum((TIME // half).astype(int), 6)  # 1 - 12 · 0.08 = 0.04 < 0.08: the sixth swing ends at rest
    centre, span = friction * (-1.0) ** swing, 1.0 - 2.0 * friction * swing - friction
    exact = (-1.0) ** swing * span * np.cos(5.0 * (TIME - swing * half)) + centre
    exact[swing == 6] = 1.0 - 12.0 * friction
    q = rolled(np.zeros_like(TIME), 1.0, kp=25.0, coulomb=2.0)
    assert np.abs(q - exact).max() < AT_STOPS
    assert np.ptp(q[-50:]) == 0.0  # it rests to the last bit


def test_a_joint_below_break_away_never_creeps():
    q = rolled(np.full_like(TIME, 0.05), kp=10.0, coulomb=0.2, static=0.4)
    assert np.ptp(q) == 0.0
    assert rolled(np.full_like(TIME, 0.07), kp=10.0, coulomb=0.2, static=0.4)[-1] > 0.0


def test_a_joint_that_reverses_inside_its_break_away_band_stays_there():
    law = {"kp": 25.0, "coulomb": 2.0, "static": 5.0}  # swings lose 0.16 rad each: 1, 0.84, ..., 0.2 < 7/25 = 0.28
    q = rolled(np.zeros_like(TIME), 1.0, **law)
    assert abs(q[-1] + 0.2) < AT_STOPS
    assert np.ptp(q[-50:]) == 0.0
    arm = swinging_alone(law_vector(**law))
    assert np.abs(arm - q).max() < AT_STOPS


def test_a_joint_that_passes_rest_beyond_its_break_away_band_goes_on():
    free, held = (rolled(np.zeros_like(TIME), 1.0, kp=25.0, coulomb=2.0, static=s) for s in (0.0, 1.0))
    until = 3.0 * np.pi / 5.0 > TIME  # to the reversal at 0.52 rad, beyond 3/25
    assert np.abs(free - held)[until].max() < AT_STOPS


def test_a_self_locking_gear_holds_its_load_when_the_drive_is_off():
    assert np.ptp(rolled(np.zeros_like(TIME), load=1.0, kp=1e-6, load_driven=1.1)) == 0.0
    assert rolled(np.zeros_like(TIME), load=1.0, kp=1e-6, load_driven=0.9)[-1] < -0.1


@pytest.mark.parametrize(("torque", "moves"), [(1.45, False), (1.55, True)])
def test_a_gear_lifts_its_load_from_a_torque_of_load_times_one_plus_k_over_one_minus_k(torque, moves):
    gear = {"load_driving": 0.2, "load_driven": 0.2, "load_motor": 0.2}  # 1.2 / 0.8 = 1.5
    q = rolled(np.full_like(TIME, 100.0), load=1.0, kp=50.0, torque_limit=torque, **gear)
    assert bool(q[-1] > 0.0) == moves
    assert moves or np.ptp(q) == 0.0


def test_a_delay_of_parts_of_a_sample_shifts_the_motion_by_as_much():
    command = np.sin(2.0 * TIME)
    law = {"kp": 400.0, "viscous": 40.0}
    late = rolled(command, **law, delay=0.03)
    prompt = np.interp(TIME - 0.03, TIME, rolled(command, **law))
    assert np.abs(late - prompt)[10:].max() < 2e-3  # a held command moves in steps of 0.04 rad


def test_a_load_is_held_with_the_sag_that_the_gain_gives():
    assert abs(rolled(np.zeros_like(TIME), load=1.0, kp=20.0, viscous=9.0)[-1] + 0.05) < SECOND_ORDER


def test_a_torque_limit_bounds_the_acceleration():
    q = rolled(np.full_like(TIME, 100.0), kp=50.0, torque_limit=2.0)
    assert np.abs(q - TIME**2).max() < SECOND_ORDER


def test_duty_is_full_beyond_its_error():
    q = rolled(np.full_like(TIME, 100.0), kp=50.0, full_error=0.04)
    assert np.abs(q - TIME**2).max() < SECOND_ORDER


def test_a_motor_that_saturates_gives_its_share_of_the_torque():
    q = rolled(np.full_like(TIME, 100.0), kp=50.0, full_error=0.06, saturation=0.5 / 3.0)  # 3 / (1 + 0.5) = 2
    assert np.abs(q - TIME**2).max() < SECOND_ORDER


@pytest.mark.parametrize(("torque", "moves"), [(1.75, False), (1.85, True)])
def test_load_dependent_friction_that_falls_with_speed_is_largest_at_rest(torque, moves):
    teeth = {"load_driving": 0.4, "load_driven": 0.4, "load_stribeck": 1.0, "stribeck_speed": 0.2}  # 1 + 0.4 (1 + 1)
    q = rolled(np.full_like(TIME, 100.0), load=1.0, kp=50.0, torque_limit=torque, **teeth)
    assert bool(q[-1] > 0.0) == moves
    assert moves or np.ptp(q) == 0.0
