"""An effort column that is no joint torque is told before physics is looked for; a wrong model is no such column."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.diagnosis.posed import of_one_mass
from validation.bad_data.sound import SoundSettings, sound_recording

from lagnet.diagnosis.data_quality.inspect import inspect_quality
from lagnet.diagnosis.diagnose import diagnose
from lagnet.errors import DiagnosisError
from lagnet.recordings.quality.finding import CERTAIN
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.robot import Robot, load_description

CONSTANTS = np.array([12.0, 15.0, 9.0, 7.0, 10.0, 6.0])  # [N m/A]


@pytest.fixture(scope="module")
def ur5() -> Robot:
    return load_description("ur5")


def recorded(robot: Robot, **settings) -> Recording:
    return sound_recording(robot, SoundSettings(**settings), np.random.default_rng(4), path="run.csv")


def told(recording: Recording, robot: Robot) -> list:
    return [f for f in inspect_quality([recording], robot) if f.check == "effort_column"]


COLUMNS = {
    "motor current": lambda r: r.tau / CONSTANTS,
    "without its sign": lambda r: np.abs(r.tau),
    "a copy of the position, in degrees": lambda r: np.degrees(r.q),
    "in N mm": lambda r: 1000.0 * r.tau,
}


@pytest.mark.parametrize("words", COLUMNS)
def test_a_column_that_is_no_joint_torque_is_told_and_left_as_it_is(words: str, ur5) -> None:
    sound = recorded(ur5)
    column = COLUMNS[words](sound)
    recording = replace(sound, tau=column.copy())
    (found,) = told(recording, ur5)
    assert words in found.detail
    assert found.mend
    assert found.certainty != CERTAIN
    assert not found.refused
    assert np.array_equal(recording.tau, column)


def scaled(robot: Robot, factors) -> Robot:
    return robot.with_inertial_parameters(robot.inertial_parameters() * np.asarray(factors)[:, None])


WRONG_MODELS = {
    "half the masses": lambda robot: scaled(robot, np.full(6, 0.5)),
    "double masses": lambda robot: scaled(robot, np.full(6, 2.0)),
    "light wrists": lambda robot: scaled(robot, [1.0, 1.0, 1.0, 0.1, 0.1, 0.1]),
    "a kilogram for each link": lambda robot: of_one_mass(robot, 1.0),
    "a gram for each link": lambda robot: of_one_mass(robot, 1e-3),
    "no link has mass": lambda robot: robot.with_inertial_parameters(np.zeros((6, 10))),
    "on a wall": lambda robot: robot.with_gravity(np.array([9.81, 0.0, 0.0])),
    "on a ceiling": lambda robot: robot.with_gravity(np.array([0.0, 0.0, 9.81])),
}


@pytest.mark.parametrize("name", WRONG_MODELS)
@pytest.mark.parametrize("viscous", [0.2, 3.0])
def test_a_wrong_model_raises_no_alarm(name: str, viscous: float, ur5) -> None:
    recording = recorded(ur5, viscous=viscous, coulomb=0.3)
    assert not [f.sentence() for f in told(recording, WRONG_MODELS[name](ur5))]


def test_noise_is_nothing_that_alarms(ur5) -> None:
    sound = recorded(ur5)
    noise = np.random.default_rng(0).standard_normal(sound.q.shape)
    assert not told(replace(sound, tau=noise), ur5)


def test_a_refusal_also_says_what_the_column_seems_to_hold(ur5) -> None:
    sound = recorded(ur5)
    with pytest.raises(DiagnosisError, match="the effort column most likely holds"):
        diagnose([replace(sound, tau=1000.0 * sound.tau)], ur5)
