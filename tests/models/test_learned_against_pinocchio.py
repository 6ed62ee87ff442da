"""A kept UR-5 DeLaN against Pinocchio on unseen motion, term by term and joint by joint; and that mutants fail."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.models.term_by_term import GravityInResidual, WithoutCoriolis, failures

from lagnet.models.files.saving import load_model
from lagnet.rigid_body.robot import load_description

pytestmark = pytest.mark.slow

FIXTURES = Path(__file__).parent / "fixtures"
TERM = 1e-3  # error power over the power of the joint's own torque: a hundred times what the kept model leaves
MASS = 1e-2  # relative Frobenius error of the mass matrix, the pass line of the ideal study


@pytest.fixture(scope="module")
def motion() -> tuple[np.ndarray, ...]:
    """States drawn independently, not from the motion the model was trained on."""
    rng = np.random.default_rng(77)
    return rng.uniform(-np.pi, np.pi, (300, 6)), rng.normal(0.0, 1.5, (300, 6)), rng.normal(0.0, 3.0, (300, 6))


@pytest.fixture(scope="module")
def robot() -> Any:
    return load_description("ur5")


@pytest.fixture(scope="module")
def model() -> Any:
    return load_model(FIXTURES / "ur5_delan")


def failed(model: Any, robot: Any, motion: tuple[np.ndarray, ...]) -> set[str]:
    return failures(model, robot, motion, TERM, MASS, 10 * TERM)


def test_the_kept_model_agrees_in_every_term(model, robot, motion):
    assert failed(model, robot, motion) == set()


def test_the_mass_matrix_is_positive_definite_everywhere(model, motion):
    assert np.linalg.eigvalsh(model.mass_matrix(motion[0])).min() > 0


@pytest.mark.slow
def test_a_model_of_shuffled_torques_fails(robot, motion):
    found = failed(load_model(FIXTURES / "ur5_shuffled"), robot, motion)
    assert {"torque", "inertial", "gravity", "mass_matrix"} <= found


def test_a_model_without_coriolis_fails(model, robot, motion):
    assert {"torque", "coriolis", "coriolis_matrix"} <= failed(WithoutCoriolis(model), robot, motion)


def test_a_model_whose_residual_took_the_gravity_fails_in_gravity_alone(model, robot, motion):
    assert failed(GravityInResidual(model), robot, motion) == {"gravity"}


def test_the_checkpoints_are_small():
    assert sum(f.stat().st_size for f in FIXTURES.rglob("*") if f.is_file()) < 2**20
