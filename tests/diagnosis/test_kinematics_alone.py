"""A model whose links have no mass: friction has its names, and the links are what recordings determine of them."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet import load_robot
from lagnet.diagnosis.diagnose import Diagnosis, diagnose
from lagnet.models.corrected.folder import load_corrected, save_corrected
from lagnet.rigid_body.random_arm import random_arm
from lagnet.simulators.corrected_arm.arm_physics import arm_physics

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("kinematics_alone")]

JOINTS = 4
SHARP = 1e-3  # [rad/s]
NOISE = 3e-5  # of the torque's variance, beyond its noise
TRUE = random_arm(JOINTS, seed=21, kinds=("revolute",), fixed=False)


def friction(q: np.ndarray, v: np.ndarray, a: np.ndarray, tau: np.ndarray) -> np.ndarray:
    """Coulomb friction at the first joint, viscous friction at the third."""
    out = np.zeros_like(v)
    out[:, 0] = 1.5 * np.tanh(v[:, 0] / SHARP)
    out[:, 2] = 0.4 * v[:, 2]
    return out


@pytest.fixture(scope="module")
def found(plant) -> Diagnosis:
    """The true arm with friction, held against its kinematics alone."""
    real = plant(friction, robot=TRUE)
    nominal = TRUE.with_inertial_parameters(np.zeros((JOINTS, 10)))
    return diagnose([real.record(1, 40.0), real.record(2, 40.0)], nominal, [real.record(3, 40.0)])


def test_friction_has_its_names_and_no_link_stands_for_others(found) -> None:
    assert {(e.effect, e.joint) for e in found.effects} == {
        ("coulomb_friction", "joint_0"),
        ("viscous_friction", "joint_2"),
    }
    sizes = {e.effect: e.parameters[0].value for e in found.effects}
    assert sizes["coulomb_friction"] == pytest.approx(1.5, rel=0.03)
    assert sizes["viscous_friction"] == pytest.approx(0.4, rel=0.03)


def test_the_identified_layer_predicts_to_the_noise(found) -> None:
    for fit in found.verdict.fit:
        assert fit.nmse_nominal > 0.5
        assert fit.nmse_identified <= fit.nmse_noise_floor + NOISE


def test_the_corrected_arm_can_be_simulated_and_has_the_true_torque(found, tmp_path) -> None:
    save_corrected(found.corrected, tmp_path / "corrected")
    robot = arm_physics(load_corrected(tmp_path / "corrected", load_robot)).robot
    q, v, a = np.random.default_rng(4).uniform(-0.5, 0.5, (3, 200, JOINTS))
    true, told = (r.inverse_dynamics(q, v, a) for r in (TRUE, robot))
    assert np.all(np.mean((true - told) ** 2, axis=0) < 0.01 * np.var(true, axis=0))
