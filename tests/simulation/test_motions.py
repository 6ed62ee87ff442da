"""Motions keep the limits, carry exact derivatives, and depend on the seed alone."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lagnet.errors import LagnetError
from lagnet.rigid_body.robot import load_description
from lagnet.simulation.motions import FREE_SPEED, SHAPES, MotionSettings, draw_motion, position_range

ARMS = {name: load_description(name) for name in ("ur5", "panda", "xarm7", "kinova")}
SETTINGS = MotionSettings(duration=6.0, rate=500.0)
DERIVATIVE = 0.05  # of the peak: central differences over 2 ms, and kinks of a move's third derivative between segments


@settings(max_examples=25, deadline=None)
@given(name=st.sampled_from(sorted(ARMS)), shape=st.sampled_from(sorted(SHAPES)), seed=st.integers(0, 2**32 - 1))
def test_motions_keep_position_speed_and_acceleration_limits(name: str, shape: str, seed: int) -> None:
    robot = ARMS[name]
    motion = draw_motion(robot, shape, SETTINGS, seed)
    for j in range(robot.n_dof):
        lower, upper = position_range(robot, j)
        assert lower <= motion.q[:, j].min()
        assert motion.q[:, j].max() <= upper
        limit = robot.velocity_limit[j] if np.isfinite(robot.velocity_limit[j]) else FREE_SPEED
        assert np.abs(motion.v[:, j]).max() <= limit
    assert np.abs(motion.a).max() <= SETTINGS.top_acceleration * (1 + 1e-12)
    assert np.abs(motion.v).max(axis=0).min() > 0  # every joint moves


@pytest.mark.parametrize("shape", SHAPES)
def test_speeds_and_accelerations_are_the_derivatives_of_positions(shape: str) -> None:
    motion = draw_motion(ARMS["ur5"], shape, SETTINGS, 3)
    for x, dx in ((motion.q, motion.v), (motion.v, motion.a)):
        seen = np.gradient(x, motion.time, axis=0)[2:-2]
        assert np.abs(seen - dx[2:-2]).max() <= DERIVATIVE * np.abs(dx).max()


def test_the_seed_decides_the_motion() -> None:
    first, again, other = (draw_motion(ARMS["ur5"], "fourier", SETTINGS, seed) for seed in (1, 1, 2))
    np.testing.assert_array_equal(first.q, again.q)
    assert np.abs(first.q - other.q).max() > 0.1


def test_sweeps_are_slower_than_moves_and_reversals_turn_more_often() -> None:
    drawn = {s: draw_motion(ARMS["ur5"], s, MotionSettings(duration=20.0), 5) for s in SHAPES}
    rms = {s: np.sqrt(np.mean(m.v**2)) for s, m in drawn.items()}
    turns = {s: np.count_nonzero(np.diff(np.sign(m.v[:, 0]))) for s, m in drawn.items()}
    assert rms["slow_sweeps"] < 0.6 * rms["random_moves"]
    assert turns["reversals"] > 2 * turns["random_moves"]


def test_an_unknown_motion_lists_the_known() -> None:
    with pytest.raises(LagnetError, match=r"unknown motion 'dance'.*fourier"):
        draw_motion(ARMS["ur5"], "dance", SETTINGS, 0)
