"""The position-controlled arm of the demo against what its servos must do by their formula."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.rigid_body.robot import load_description
from lagnet.simulation.servo_arm import (
    ENCODER,
    RANGES,
    SAMPLE,
    SERVO,
    HiddenEffect,
    draw_hidden,
    record_motion,
    write_desk_arm,
)


@pytest.fixture(scope="module")
def arm(tmp_path_factory):
    return load_description(write_desk_arm(tmp_path_factory.mktemp("arm") / "arm.urdf"))


def test_at_rest_the_servo_error_is_the_load_over_kp_within_the_friction(arm):
    recording = record_motion(arm, (), 10.0, 3)
    at = [k for k in range(80, 500, 100) if np.ptp(recording.q[k : k + 15], axis=0).max() == 0.0]
    assert at
    load = arm.gravity_torque(recording.q[at])
    torque = SERVO["kp"] * (recording.command[at] - recording.q[at])
    assert np.abs(torque - load).max() < SERVO["coulomb"] + SERVO["kp"] * ENCODER


def test_delayed_joints_start_by_so_much_later(arm):
    late = tuple(HiddenEffect("command_delay", joint, "delay", "T", 0.06) for joint in (0, 1))
    starts = []
    for hidden in ((), late):
        recording = record_motion(arm, hidden, 4.0, 3)
        moved = np.abs(recording.q[100:, 0] - recording.q[100, 0]) > 5.0 * ENCODER  # the command steps at 2 s
        starts.append(int(np.argmax(moved)))
    assert starts[1] - starts[0] == round(0.06 / SAMPLE)


def test_one_effect_of_its_own_kind_is_drawn_for_every_joint():
    hidden = draw_hidden(2, 5)
    assert [e.joint for e in hidden] == [0, 1]
    assert len({e.effect for e in hidden}) == 2
    for effect in hidden:
        parameter, key, low, high = RANGES[effect.effect]
        assert (effect.parameter, effect.key) == (parameter, key)
        assert low <= effect.value <= high
    assert draw_hidden(2, 5) == hidden
