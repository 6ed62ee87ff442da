"""Holding a model against Pinocchio term by term and joint by joint, and mutants that must not pass."""

from __future__ import annotations

from typing import Any

import numpy as np


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


def failures(
    model: Any, robot: Any, motion: tuple[np.ndarray, ...], term: float, mass: float, moved: float
) -> set[str]:
    """The terms in which a model is further from Pinocchio than allowed on any joint, or not a number.

    Args:
        model: to be judged; robot: Pinocchio; motion: (q, v, a).
        term: allowed error power of a torque term, over the power of the joint's own torque.
        mass: allowed relative Frobenius error of the mass matrix and of the Coriolis matrix.
        moved: allowed error power of the acceleration under the true torque, over that of the acceleration.
    """
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
    found = {name for name, (x, y) in pairs.items() if not np.all(np.mean((x - y) ** 2, axis=0) <= term * size)}
    true = robot.mass_matrix(q)
    if not np.linalg.norm(model.mass_matrix(q) - true) <= mass * np.linalg.norm(true):
        found.add("mass_matrix")
    true = robot.coriolis_matrix(q, v)
    if not np.linalg.norm(model.coriolis_matrix(q, v) - true) <= mass * np.linalg.norm(true):
        found.add("coriolis_matrix")
    reached = model.forward_dynamics(q, v, tau)
    if not np.all(np.mean((reached - a) ** 2, axis=0) <= moved * np.mean(a**2, axis=0)):
        found.add("forward_dynamics")
    return found
