"""A body's ten inertial parameters, about its frame or about its centre of mass."""

from __future__ import annotations

import numpy as np

ENTRIES = ((0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2))  # Ixx Ixy Iyy Ixz Iyz Izz, Pinocchio's order


def _shift(mass: float, centre: np.ndarray) -> np.ndarray:
    """Inertia of a point mass about the origin of the frame, shape (3, 3)."""
    return mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))


def parameters_of_body(mass: float, centre: np.ndarray, inertia: np.ndarray) -> np.ndarray:
    """(m, m c, I about the frame), shape (10,), of a mass [kg], its centre (3,) [m] and inertia about it (3, 3)."""
    about_frame = inertia + _shift(mass, centre)
    return np.array([mass, *(mass * centre), *(about_frame[e] for e in ENTRIES)])


def inertia_about_centre(parameters: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Centre of mass (3,) [m] and inertia about it (3, 3) [kg m²] of ten parameters (10,) with positive mass."""
    mass, centre = parameters[0], parameters[1:4] / parameters[0]
    about_frame = np.zeros((3, 3))
    for value, (i, j) in zip(parameters[4:], ENTRIES, strict=True):
        about_frame[i, j] = about_frame[j, i] = value
    return centre, about_frame - _shift(mass, centre)


def is_physical(mass: float, inertia: np.ndarray, slack: float = 1e-9) -> bool:
    """Whether positive mass can have this inertia about its centre: no principal moment exceeds the other two."""
    moments = np.linalg.eigvalsh(inertia)
    return mass > 0 and moments[0] >= -slack and moments[0] + moments[1] >= moments[2] - slack
