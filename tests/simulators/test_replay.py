"""Recorded commands through an engine: the corrected model stays near, and the horizon says for how long."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.errors import RobotError
from lagnet.models.corrected.identified import IdentifiedLayer
from lagnet.models.corrected.model import CorrectedModel, NamedEffect
from lagnet.models.corrected.motion_terms import Rest
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.random_arm import random_arm
from lagnet.simulators.before_after import TABLE_RATE, BeforeAfter, before_and_after, columns_of
from lagnet.simulators.corrected_arm.arm_physics import arm_physics
from lagnet.simulators.corrected_arm.driven_arm import DrivenArm
from lagnet.simulators.replay import ReplaySettings, Servo

ARM = random_arm(2, seed=3, kinds=("revolute",), fixed=False)
KP, KD = (60.0, 40.0), (6.0, 4.0)
SECONDS, RATE, TOLERANCE = 3.0, 1000, 0.02
BLUR = np.full(2, 1e-3)  # [rad/s] of s(v)


@pytest.fixture(scope="module")
def result() -> BeforeAfter:
    """An arm with friction that follows commands by a PD controller, replayed without and with its friction."""
    effects = [NamedEffect("viscous_friction", j, {"Fv": 3.0}) for j in range(2)]
    model = CorrectedModel(ARM, tuple(effects), BLUR)
    time = np.arange(int(SECONDS * RATE)) / RATE
    command = np.column_stack([0.5 * np.sin(2.0 * time), 0.4 * np.sin(3.0 * time)])
    arm, q = DrivenArm(arm_physics(model), 1.0 / RATE, command[0], np.array([1.0, 1.2])), np.empty_like(command)
    for k in range(time.size):
        q[k], v = arm.read()
        arm.advance(np.array(KP) * (command[k] - q[k]) - np.array(KD) * v, 1.0 / RATE)
    recording = Recording(time, q, None, ARM.joints, command=command, path="run.csv")
    settings = ReplaySettings(tolerance=TOLERANCE, servo=Servo(KP, KD))
    return before_and_after(model, [recording], settings)


def test_commands_have_a_horizon_before_and_after(result: BeforeAfter) -> None:
    assert result.after is not None
    before, after = result.before.horizon, result.after.horizon
    assert before is not None
    assert after is not None
    error = np.abs(result.before.runs[0].q - result.before.runs[0].q_measured).max(axis=1)
    assert before.seconds[0] == pytest.approx(np.argmax(error > TOLERANCE) / RATE)
    assert before.left.tolist() == [True]
    assert after.left.tolist() == [False]
    assert after.seconds[0] == pytest.approx(result.after.runs[0].time.size / RATE)


def test_the_nominal_model_may_be_a_corrected_one() -> None:
    """Before is then what the user had, not the bare robot under all corrections."""
    known = CorrectedModel(ARM, (NamedEffect("viscous_friction", 0, {"Fv": 3.0}),), BLUR)
    model = CorrectedModel(known, (NamedEffect("viscous_friction", 1, {"Fv": 3.0}),), BLUR)
    time = np.arange(600) / RATE
    q = np.column_stack([np.sin(3.0 * time), np.cos(2.0 * time)])
    recording = Recording(time, q, None, ARM.joints, command=q, path="run.csv")
    settings = ReplaySettings(servo=Servo(KP, KD))
    given = before_and_after(model, [recording], settings, known)
    bare = before_and_after(model, [recording], settings)
    assert np.abs(given.before.runs[0].q - bare.before.runs[0].q).max() > 1e-3
    assert given.after is not None
    assert bare.after is not None
    np.testing.assert_array_equal(given.after.runs[0].q, bare.after.runs[0].q)


def test_trajectories_are_kept_at_no_more_than_their_rate(result: BeforeAfter) -> None:
    columns = columns_of(result)
    np.testing.assert_allclose(np.diff(columns["time"]), 1.0 / TABLE_RATE)
    every = round(RATE / TABLE_RATE)
    np.testing.assert_array_equal(columns["q_before_1"], result.before.runs[0].q[::every, 1])
    assert result.to_json()["units"] == ["rad", "rad"]


def test_links_without_mass_are_replayed_as_recordings_determine_them_and_not_before() -> None:
    empty = ARM.with_inertial_parameters(np.zeros((2, 10)))
    layer = IdentifiedLayer(ARM.inertial_parameters(), (), np.zeros(0), Rest(BLUR, np.zeros(2)))
    time = np.arange(600) / RATE
    q = np.column_stack([0.2 * np.sin(3.0 * time), 0.2 * np.cos(2.0 * time)])
    recording = Recording(time, q, None, ARM.joints, command=q, path="run.csv")
    settings = ReplaySettings(servo=Servo(KP, KD))
    found = before_and_after(CorrectedModel(empty, (), BLUR, identified=layer), [recording], settings)
    assert found.after is None
    known = before_and_after(ARM, [recording], settings)
    np.testing.assert_allclose(found.before.runs[0].q, known.before.runs[0].q, atol=1e-6)
    with pytest.raises(RobotError, match="nothing behind joint joint_0 has mass"):
        before_and_after(empty, [recording], settings)
