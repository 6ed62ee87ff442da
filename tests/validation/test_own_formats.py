"""The robot of the LeRobot set: two arms, mirrored, whose joints are found in the log by name."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from validation.own_formats.g1_arms import g1_arms
from validation.own_formats.study import summary

from lagnet.recordings.loading.joint_match import match_joints
from lagnet.rigid_body.robot import Robot, load_description


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> Robot:
    path = Path(tmp_path_factory.mktemp("g1") / "g1_arms.urdf")
    path.write_text(g1_arms(), encoding="utf-8")
    return load_description(path)


def test_both_arms_weigh_the_same_in_mirrored_poses(robot: Robot) -> None:
    left = np.random.default_rng(0).uniform(-0.8, 0.8, (5, 7))
    mirror = np.array([1.0, -1.0, -1.0, 1.0, -1.0, 1.0, -1.0])  # turns about y stay, those about x and z change sense
    still = np.zeros((5, 14))
    torque = robot.inverse_dynamics(np.hstack([left, mirror * left]), still, still)
    np.testing.assert_allclose(
        torque[:, 7:], mirror * torque[:, :7], atol=2e-3
    )  # the maker's shoulders differ by 10 µm
    assert np.abs(torque).max() > 1.0


def test_joints_of_the_log_are_found_without_their_prefix(robot: Robot) -> None:
    parts = ["ShoulderPitch", "ShoulderRoll", "ShoulderYaw", "Elbow", "WristRoll", "WristPitch", "WristYaw"]
    log = [f"k{side}{part}" for side in ("Right", "Left") for part in parts] + ["kLeftHandPinky"]
    found = match_joints(log, robot.joints)
    assert found.index == (*range(7, 14), *range(7))
    assert found.unused == ("kLeftHandPinky",)


def test_a_summary_takes_positions_on_motion_and_the_identified_layer_on_torque() -> None:
    row = {"rmse_nominal": 0.12345, "rmse_named": 0.1, "nmse_nominal": 0.5, "nmse_identified": 0.25}
    verdict = {
        "fit": [row],
        "effects": [{"effect": "coulomb_friction", "joint": "a"}],
        "warnings": [],
        "route": "motion",
    }
    assert summary(verdict)["before"] == [0.123]
    assert summary(verdict | {"route": "torque"})["after"] == [0.25]
    assert summary(verdict)["names"] == ["coulomb_friction a"]
