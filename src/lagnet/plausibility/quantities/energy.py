"""Kinetic and potential energy of any model: its own where it offers them, else from H and g."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.subject import Subject


def kinetic_energy(subject: Subject, q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Kinetic energy [J], shape (n,)."""
    if subject.offers("kinetic_energy"):
        return subject.call("kinetic_energy", q, v)
    return 0.5 * np.einsum("ni,nij,nj->n", v, subject.mass_matrix(q), v)


def energy_scale(subject: Subject) -> float:
    """Work that typical torques do in one second at the speeds of the box of motion [J]."""
    return float(subject.torque_scale @ subject.ranges.velocity)
