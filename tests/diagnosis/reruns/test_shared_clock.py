"""Torque that is held, or stamped half a cycle off: told as a property of the log, not as physics of joints."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from tests.diagnosis.conftest import NOISE

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.writing import holdout_table

pytestmark = pytest.mark.slow

HALF = 0.005  # [s] of a sample


def stamped(recording, joints, by):
    """The recording with torques of some joints stamped earlier by a time [s]."""
    tau = recording.tau.copy()
    later = np.clip(recording.time + by, recording.time[0], recording.time[-1])
    tau[:, joints] = CubicSpline(recording.time, recording.tau)(later)[:, joints]
    return replace(recording, tau=tau)


@pytest.mark.parametrize("by", [HALF, -HALF])
def test_a_shift_that_all_joints_share_is_no_physics_of_theirs(plant, by):
    arm = plant()
    recordings = [stamped(arm.record(seed), [0, 1, 2], by) for seed in (1, 2)]
    found = diagnose(recordings, arm.robot, [stamped(arm.record(3), [0, 1, 2], by)])
    assert not found.effects
    (told,) = (w for w in found.verdict.warnings if "stamped" in w)
    assert ("earlier" if by > 0 else "later") in told
    table = holdout_table(found).to_pydict()  # holds what was recorded, and predictions of the same instants
    rest = [np.std(np.subtract(table[f"tau_measured_{j}"], table[f"tau_corrected_{j}"])) for j in range(3)]
    assert np.all(rest < 1.3 * NOISE * arm.usual_torque())


def test_what_else_was_left_out_is_named_beside_it(plant, at):
    level = 0.2 * plant().usual_torque()[1]
    arm = plant(at(1, lambda q, v, a, load: level * np.tanh(v / 1e-3)))
    recordings = [stamped(arm.record(seed), [0, 1, 2], HALF) for seed in (1, 2)]
    found = diagnose(recordings, arm.robot, [stamped(arm.record(3), [0, 1, 2], HALF)])
    assert [(e.effect, e.joint) for e in found.effects] == [("coulomb_friction", arm.robot.joints[1])]


def test_a_delay_that_other_joints_deny_stays_a_delay(plant):
    arm = plant()
    recordings = [stamped(arm.record(seed), [1], -HALF) for seed in (1, 2)]
    found = diagnose(recordings, arm.robot, [stamped(arm.record(3), [1], -HALF)])
    assert [(e.effect, e.joint) for e in found.effects] == [("time_delay", arm.robot.joints[1])]
    assert found.effects[0].parameters[0].value == pytest.approx(HALF, rel=0.1)
    assert not any("stamped" in w for w in found.verdict.warnings)
