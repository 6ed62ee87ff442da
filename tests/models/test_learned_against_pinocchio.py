"""A kept UR-5 DeLaN against Pinocchio on unseen motion, term by term and joint by joint; and that mutants fail."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lagnet.models.saving import load_model
from lagnet.rigid_body.robot import load_description

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


class WithoutCoriolis:
    """A mutant that forgets centrifugal and Coriolis torque."""

    def __init__(self, model: Any):
        self.mass_matrix, self.gravity_torque, self.forward_dynamics = (
            model.mass_matrix,
            model.gravity_torque,
            model.forward_dynamics,
        )
        self._model = model

    def inverse_dynamics(self, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
        return self._model.inverse_dynamics(q, np.zeros_like(v), a)

    def coriolis_torque(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        return np.zeros_like(q)

    def coriolis_matrix(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        return np.zeros((*q.shape, q.shape[1]))


class GravityInResidual:
    """A mutant with the right total torque, whose ε has taken the gravity."""

    def __init__(self, model: Any):
        self.mass_matrix, self.coriolis_torque, self.coriolis_matrix = (
            model.mass_matrix,
            model.coriolis_torque,
            model.coriolis_matrix,
        )
        self.inverse_dynamics, self.forward_dynamics = model.inverse_dynamics, model.forward_dynamics
        self.residual_torque = lambda q, v, a: model.gravity_torque(q)

    def gravity_torque(self, q: np.ndarray) -> np.ndarray:
        return np.zeros_like(q)


def failures(model: Any, robot: Any, motion: tuple[np.ndarray, ...]) -> set[str]:
    """The terms in which a model is further from Pinocchio than allowed, on any joint."""
    q, v, a = motion
    tau = robot.inverse_dynamics(q, v, a)
    size = np.mean(tau**2, axis=0)
    pairs = {
        "torque": (model.inverse_dynamics(q, v, a), tau),
        "inertial": tuple(np.einsum("nij,nj->ni", x.mass_matrix(q), a) for x in (model, robot)),
        "coriolis": (model.coriolis_torque(q, v), robot.coriolis_torque(q, v)),
        "coriolis_matrix": tuple(np.einsum("nij,nj->ni", x.coriolis_matrix(q, v), a) for x in (model, robot)),
        "gravity": (model.gravity_torque(q), robot.gravity_torque(q)),
    }
    found = {name for name, (x, y) in pairs.items() if np.any(np.mean((x - y) ** 2, axis=0) > TERM * size)}
    true = robot.mass_matrix(q)
    if np.linalg.norm(model.mass_matrix(q) - true) > MASS * np.linalg.norm(true):
        found.add("mass_matrix")
    moved = model.forward_dynamics(q, v, tau)
    if np.any(np.mean((moved - a) ** 2, axis=0) > 10 * TERM * np.mean(a**2, axis=0)):
        found.add("forward_dynamics")
    return found


def test_the_kept_model_agrees_in_every_term(model, robot, motion):
    assert failures(model, robot, motion) == set()


def test_the_coriolis_matrix_is_pinocchios_entry_by_entry(model, robot, motion):
    q, v, _ = motion
    true = robot.coriolis_matrix(q, v)
    assert np.linalg.norm(model.coriolis_matrix(q, v) - true) < MASS * np.linalg.norm(true)


def test_the_mass_matrix_is_positive_definite_everywhere(model, motion):
    assert np.linalg.eigvalsh(model.mass_matrix(motion[0])).min() > 0


def test_a_model_of_shuffled_torques_fails(robot, motion):
    found = failures(load_model(FIXTURES / "ur5_shuffled"), robot, motion)
    assert {"torque", "inertial", "gravity", "mass_matrix"} <= found


def test_a_model_without_coriolis_fails(model, robot, motion):
    assert {"torque", "coriolis", "coriolis_matrix"} <= failures(WithoutCoriolis(model), robot, motion)


def test_a_model_whose_residual_took_the_gravity_fails_in_gravity_alone(model, robot, motion):
    assert failures(GravityInResidual(model), robot, motion) == {"gravity"}


def test_the_checkpoints_are_small():
    assert sum(f.stat().st_size for f in FIXTURES.rglob("*") if f.is_file()) < 2**20
