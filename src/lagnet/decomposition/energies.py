"""Where the work goes: kinetic and potential energy along a motion, and the balance of powers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from lagnet.decomposition.offers import offers
from lagnet.decomposition.terms import CHUNK, Terms
from lagnet.types import Samples, Trajectory


@dataclass(frozen=True, eq=False)
class Energies:
    """Energies [J] and powers [W] along a motion, each of shape (n,).

    Args:
        kinetic: ½ vᵀ H v.
        potential: energy of position, zero at the start of each trajectory.
        measured_power: power of the measured torque.
        model_power: power of the model's torque.
        residual_power: power that the model's residual takes out of the arm.
        imbalance: energy gained beyond the work of inertial, Coriolis and gravity torque since the trajectory began:
            zero for mechanics, up to the samples' spacing.
    """

    kinetic: Samples
    potential: Samples
    measured_power: Samples
    model_power: Samples
    residual_power: Samples
    imbalance: Samples


def energies_of(
    models: Sequence[Any],
    time: Samples,
    trajectory: np.ndarray,
    q: Trajectory,
    v: Trajectory,
    terms: Terms,
    measured: Trajectory,
) -> Energies:
    """Energies along a motion.

    Potential energy is the model's own where it has one, else the work against its gravity torque.

    Args:
        models: one, or the members of an ensemble; see lagnet.types.InverseDynamics.
        time, trajectory: shape (n,), clock and label of the motion.
        q, v: shape (n, dof), motion.
        terms: the model's torque along it.
        measured: shape (n, dof), measured torque [N m].
    """
    kinetic = np.mean([_kinetic(model, q, v) for model in models], axis=0)
    potential = _potential(models, time, trajectory, q, v, terms.gravity)
    mechanical = np.sum((terms.inertial + terms.coriolis + terms.gravity) * v, axis=1)
    energy = kinetic + potential
    gained = energy - energy[_begin(trajectory)]
    return Energies(
        kinetic=kinetic,
        potential=potential,
        measured_power=np.sum(measured * v, axis=1),
        model_power=np.sum(terms.total * v, axis=1),
        residual_power=np.sum(terms.residual * v, axis=1),
        imbalance=gained - _integral(time, trajectory, mechanical),
    )


def work(time: Samples, trajectory: np.ndarray, power: Samples) -> float:
    """Integral of a power over all trajectories [J]."""
    inside = np.diff(trajectory) == 0
    return float(np.sum((np.diff(time) * (power[1:] + power[:-1]) / 2)[inside]))


def _kinetic(model: Any, q: Trajectory, v: Trajectory) -> Samples:
    def piece(rows: slice) -> np.ndarray:
        H = np.asarray(model.mass_matrix(q[rows]), dtype=float)
        return 0.5 * np.einsum("ni,nij,nj->n", v[rows], H, v[rows])

    return np.concatenate([piece(slice(k, k + CHUNK)) for k in range(0, max(len(q), 1), CHUNK)])


def _potential(
    models: Sequence[Any], time: Samples, trajectory: np.ndarray, q: Trajectory, v: Trajectory, gravity: Trajectory
) -> Samples:
    if len(models) == 1 and offers(models[0], "potential_energy"):
        energy = np.asarray(models[0].potential_energy(q), dtype=float)
        return energy - energy[_begin(trajectory)]
    return _integral(time, trajectory, np.sum(gravity * v, axis=1))


def _begin(trajectory: np.ndarray) -> np.ndarray:
    """Row at which the trajectory of each sample begins, shape (n,)."""
    starts = np.concatenate([[0], np.flatnonzero(np.diff(trajectory)) + 1])
    return np.repeat(starts, np.diff(np.concatenate([starts, [trajectory.size]])))


def _integral(time: Samples, trajectory: np.ndarray, power: Samples) -> Samples:
    """Running integral by trapezes, zero at the start of each trajectory, shape (n,)."""
    pieces = np.diff(time) * (power[1:] + power[:-1]) / 2
    pieces[np.diff(trajectory) != 0] = 0.0
    running = np.concatenate([[0.0], np.cumsum(pieces)])
    return running - running[_begin(trajectory)]
