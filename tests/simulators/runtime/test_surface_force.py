"""The force of a surface in PyBullet: where its point is and how joints move it, against the model's own."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from lagnet.models.corrected.servo_driven import ServoDrivenModel
from lagnet.rigid_body.kinematic_tree import kinematic_tree
from lagnet.rigid_body.random_arm import random_arm
from lagnet.rollout.surface import heights_of, levers_of
from lagnet.servos.parameters import law_vector
from lagnet.simulators.corrected_arm.servo_arm import servo_arm
from lagnet.simulators.runtime.run_servo_pybullet import ServoArm
from lagnet.simulators.servo_exporters.registry import SERVO_EXPORTERS

ARM = random_arm(4, seed=7, kinds=("revolute", "prismatic"), fixed=False)
SURFACE = np.array([3.0, 0.05, -0.03, 0.2, 0.1, 2e3, 0.3])
POSES = np.random.default_rng(0).uniform(-1.0, 1.0, (5, 4))


def exported(folder: Path, **law: float) -> ServoArm:
    laws = np.tile(law_vector(kp=20.0, kd=1.0, rotor=0.1, **law), (4, 1))
    SERVO_EXPORTERS["pybullet"].write(servo_arm(ServoDrivenModel(ARM, laws, (True,) * 4, surface=SURFACE)), folder)
    return ServoArm(folder)


@pytest.mark.parametrize("pose", POSES)
def test_heights_and_levers_are_those_of_the_model(tmp_path: Path, pose: np.ndarray) -> None:
    arm, tree = exported(tmp_path), kinematic_tree(ARM)
    arm.put(pose, np.zeros(4))
    at, jacobian = arm.surface.point()
    up = arm.surface.axes[0]
    assert up @ at - SURFACE[4] == pytest.approx(heights_of(tree, SURFACE, pose[None])[0], abs=1e-6)
    assert (up @ jacobian)[arm.motors] == pytest.approx(levers_of(tree, SURFACE, pose[None])[0], abs=1e-6)
    arm.close()


def test_the_point_slides_as_its_jacobian_says(tmp_path: Path) -> None:
    arm = exported(tmp_path)
    arm.put(POSES[0], np.zeros(4))
    at, jacobian = arm.surface.point()
    for j, step in enumerate(1e-4 * np.eye(4)):
        arm.put(POSES[0] + step, np.zeros(4))
        assert (arm.surface.point()[0] - at) / 1e-4 == pytest.approx(jacobian[:, arm.motors[j]], abs=1e-3)
    arm.close()


def test_above_it_nothing_acts_and_a_yielding_joint_feels_none(tmp_path: Path) -> None:
    arm = exported(tmp_path)
    heights = heights_of(kinematic_tree(ARM), SURFACE, POSES)
    for pose, height in zip(POSES, heights, strict=True):
        arm.put(pose, np.zeros(4))
        force, beside = arm.surface.acting(np.zeros(4), 1e-3)
        assert np.any(force != 0.0) == np.any(beside != 0.0) == (height < 0.0)
    arm.close()
    arm = exported(tmp_path, stiffness=200.0)
    assert not arm.surface.share.any()
    arm.close()
    assert {h < 0.0 for h in heights} == {True, False}
