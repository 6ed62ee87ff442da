"""Masses that no real arm has: said aloud, and refused where motion under torque is asked for and none is defined."""

from __future__ import annotations

import numpy as np

from lagnet.errors import RobotError
from lagnet.rigid_body.descriptions.description import moving_bodies
from lagnet.rigid_body.untyped_pinocchio import Model, pin

SINGULAR = 1e-10  # of the largest eigenvalue of a mass matrix scaled to a unit diagonal; real arms stay above 1e-4
POSES = 5
MOST_JOINTS = 256  # tables grow as the square: two thousand joints take more than a gigabyte
KINEMATICS_ALONE = (
    "no link has mass: kinematics alone. A diagnosis finds what recordings determine of the links; the model itself"
    " cannot be simulated"
)


def mass_warnings(model: Model, where: str) -> list[str]:
    """Warnings on bodies without mass, and on a mass matrix without inverse.

    Raises:
        RobotError: more than 256 joints.
    """
    if model.nv > MOST_JOINTS:
        raise RobotError(
            f"has {model.nv} moving joints, more than {MOST_JOINTS}",
            where=where,
            next_step="give a model of the part that moves, other joints fixed",
        )
    masses = np.array([model.inertias[i].mass for i in range(1, model.njoints)])
    if not masses.any():
        return [KINEMATICS_ALONE]
    warnings = []
    for i, mass in enumerate(masses, start=1):
        if mass <= 0:
            warnings.append(f"the body behind joint {model.names[i]} has a mass of {mass:g} kg")
    return warnings + _singular_warnings(model)


def require_mass(model: Model, where: str) -> None:
    """Nothing for an arm that torque can move.

    Raises:
        RobotError: a joint with nothing that has mass behind it.
    """
    for i in joints_without_mass(model):
        raise RobotError(
            f"nothing behind joint {model.names[i]} has mass",
            where=where,
            next_step=f"give link {moving_bodies(model)[i - 1]} an inertial, or make the joint fixed",
        )


def joints_without_mass(model: Model) -> list[int]:
    """Pinocchio's numbers of the joints behind which no body has mass or inertia: torque cannot move these."""
    empty = [body.mass == 0 and not np.any(body.inertia) for body in model.inertias]
    return [i for i in range(1, model.njoints) if all(empty[j] for j in model.subtrees[i])]


def _singular_warnings(model: Model) -> list[str]:
    """Looks at a few random poses: an arm whose mass matrix has no inverse has no forward dynamics."""
    generator, data = np.random.default_rng(0), model.createData()
    for _ in range(POSES):
        matrix = np.triu(pin.crba(model, data, generator.uniform(-1.0, 1.0, model.nq)).reshape(model.nv, model.nv))
        matrix = matrix + np.triu(matrix, 1).T
        diagonal = np.diag(matrix)
        if diagonal.min() <= SINGULAR * diagonal.max():
            name = model.names[1 + int(np.argmin(diagonal))]
            return [f"joint {name} feels no inertia: the mass matrix has no inverse, forward dynamics is undefined"]
        scaled = np.linalg.eigvalsh(matrix / np.sqrt(np.outer(diagonal, diagonal)))
        if scaled[0] <= SINGULAR * scaled[-1]:
            return ["the mass matrix is not positive definite: forward dynamics is undefined in some poses"]
    return []
