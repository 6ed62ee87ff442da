"""The Stribeck curve where its speed is zero or next to it: dry friction alone, and more of it at standstill only."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.effects.catalogue import effect_named
from lagnet.effects.motion import Motion

SPEEDS = np.array([-1.0, -1e-3, 0.0, 1e-3, 1.0])


def motion_at(speeds: np.ndarray, held: np.ndarray | None = None) -> Motion:
    n = len(speeds)
    rest = np.zeros((n, 1))
    slow = np.array([1e-6])
    return Motion(np.arange(n) * 0.01, rest, speeds[:, None], rest, rest, slow, None, held=held)


@pytest.mark.parametrize("vs", [0.0, -0.0, 5e-324, 1e-200])
def test_a_stribeck_speed_of_zero_leaves_dry_friction_alone(vs):
    torque = effect_named("stribeck_friction").torque(motion_at(SPEEDS), 0, {"Fc": 2.0, "Fs": 3.0, "vs": vs})
    np.testing.assert_array_equal(torque, [-2.0, -2.0, 0.0, 2.0, 2.0])


def test_a_joint_held_at_standstill_bears_the_whole_breakaway_torque():
    motion = motion_at(np.repeat([1.0, 0.0], 20), held=np.ones(1))
    columns = effect_named("stribeck_friction").columns(motion, 0, {"vs": 0.0})
    np.testing.assert_array_equal(columns[:, 1], np.where(motion.v[:, 0] == 0.0, columns[:, 0], 0.0))
    np.testing.assert_array_equal(columns[20:, 1], 1.0)


@pytest.mark.parametrize(("slowest", "seen"), [(0.0, 5.0), (0.002, 5.0 / np.e), (0.006, 5.0 * np.exp(-9.0))])
def test_friction_that_rises_below_the_slowest_speed_is_not_seen(slowest, seen):
    values, speed = {"Fc": 20.0, "Fs": 100.0, "vs": 0.002}, np.array([-1.0, slowest, 0.5])
    plain, share = effect_named("stribeck_friction").further_term(values, speed)
    assert plain == "coulomb_friction"
    assert share == pytest.approx(seen, rel=1e-9)
