"""Recordings that are whole but wrong are told with their cause, before any physics is looked for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from validation.bad_data.corruptions import CORRUPTIONS
from validation.bad_data.sound import SoundSettings, sound_recording

from lagnet.diagnosis.data_quality.check import fits_far_better
from lagnet.diagnosis.data_quality.checks import CHECK_NAMES
from lagnet.diagnosis.data_quality.inspect import inspect_quality
from lagnet.rigid_body.robot import Robot, load_description


@pytest.fixture(scope="module")
def ur5() -> Robot:
    return load_description("ur5")


@pytest.fixture(scope="module")
def recordings(ur5) -> list:
    rng = np.random.default_rng(4)
    return [sound_recording(ur5, SoundSettings(), rng, path=f"run_{k}.csv") for k in range(2)]


def test_sound_recordings_raise_no_alarm(ur5, recordings) -> None:
    assert not [f.sentence() for f in inspect_quality(recordings, ur5)]


@pytest.mark.parametrize("corruption", CORRUPTIONS, ids=lambda c: c.name)
def test_the_cause_is_told(corruption, ur5, recordings) -> None:
    broken = corruption.do(list(recordings), np.random.default_rng(1))
    found = inspect_quality(broken, ur5)
    assert any(word in f.detail for f in found for word in corruption.words), [f.sentence() for f in found]
    assert corruption.survived or any(f.refused for f in found)


@pytest.mark.parametrize("other", ["ur10", "ur3"])
def test_the_log_of_another_robot_is_told(other, ur5) -> None:
    rng = np.random.default_rng(2)
    (found,) = inspect_quality([sound_recording(load_description(other), SoundSettings(), rng)], ur5)
    assert found.refused
    assert found.mend.startswith(f"give --robot {other}")


@pytest.mark.parametrize("mass", [0.0, 1.0])
def test_a_model_without_masses_is_of_no_other_robot(mass, ur5, recordings) -> None:
    """Kinematics of the arm that was recorded, and links without mass or of a kilogram each."""
    links = np.zeros((ur5.n_dof, 10))
    links[:, 0], links[:, [4, 6, 9]] = mass, 0.01 * mass
    assert not [f for f in inspect_quality(recordings, ur5.with_inertial_parameters(links)) if f.refused]


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_rough_model_of_the_arm_is_of_no_other_robot(seed, ur5, recordings) -> None:
    guessed = ur5.inertial_parameters() * np.random.default_rng(seed).uniform(0.3, 2.5, (ur5.n_dof, 1))
    assert not [f for f in inspect_quality(recordings, ur5.with_inertial_parameters(guessed)) if f.refused]


def test_an_arm_with_much_that_the_model_lacks_is_no_bad_data(ur5) -> None:
    """A heavy payload, strong friction: physics, and not another order, clock or robot."""
    settings = SoundSettings(viscous=1.5, coulomb=1.0)
    loaded = ur5.with_inertial_parameters(_heavier(ur5)) if hasattr(ur5, "with_inertial_parameters") else ur5
    recording = sound_recording(loaded, settings, np.random.default_rng(3))
    assert not [f.sentence() for f in inspect_quality([recording], ur5)]


WRISTS = 3  # joints of which the model explains no torque


@pytest.fixture(scope="module")
def half_explained(recordings) -> list:
    """Recordings whose wrists carry torques that no rigid body explains, as strong wrist friction would."""
    rng, out = np.random.default_rng(5), []
    for r in recordings:
        dof = r.n_dof
        size = np.where(np.arange(dof) < dof - WRISTS, 0.25, 8.0) * np.std(r.tau, axis=0)
        waves = np.sin(np.outer(r.time, rng.uniform(1.0, 4.0, dof)) + rng.uniform(0, 6, dof))
        out.append(replace(r, tau=r.tau + size * waves))
    return out


def test_joints_that_the_model_explains_in_no_reading_raise_no_alarm(ur5, half_explained) -> None:
    assert not [f.sentence() for f in inspect_quality(half_explained, ur5)]


@pytest.mark.parametrize("name", ["joints reversed", "torque 300 ms late"])
def test_the_cause_is_told_by_the_joints_that_the_model_explains(name, ur5, half_explained) -> None:
    corruption = next(c for c in CORRUPTIONS if c.name == name)
    found = inspect_quality(corruption.do(list(half_explained), np.random.default_rng(1)), ur5)
    assert any(word in f.detail for f in found for word in corruption.words), [f.sentence() for f in found]


def test_joints_that_no_interpretation_explains_tell_nothing() -> None:
    neither, right, wrong = [0.9, 1.0, 1.1], [0.05, 0.05, 0.05], [3.0, 3.0, 3.0]
    assert fits_far_better(np.array(right + neither), np.array(wrong + neither))
    assert not fits_far_better(np.array(right[:1] + neither), np.array(wrong[:1] + neither))
    assert not fits_far_better(np.array([0.05, 5.0, 5.0]), np.array([3.0, 0.9, 0.9]))


def _heavier(robot: Robot) -> np.ndarray:
    bodies = np.array(robot.inertial_parameters(), dtype=float)
    bodies[-1] += np.array([4.0, 0.0, 0.0, 0.4, 0.05, 0.0, 0.05, 0.0, 0.0, 0.01])
    return bodies


def test_every_reading_has_a_corruption() -> None:
    orders = {"joint_order"}
    assert set(CHECK_NAMES) == {*orders, "clock_scale", "position_unit", "torque_lag", "another_robot"}


@pytest.mark.parametrize(("telling", "fits"), [(1, False), (2, True)])
def test_of_an_arm_of_two_joints_both_must_speak(telling: int, fits: bool) -> None:
    recorded, read = np.array([0.9, 0.9]), np.array([0.05, 0.7])
    read[:telling] = 0.05
    assert fits_far_better(read, recorded) == fits
    assert fits_far_better(read[:1], recorded[:1])  # of one joint there is no other
