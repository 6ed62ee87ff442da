"""Errors of a model's torque and of its parts against a reference, on raw arrays, joint by joint."""

from __future__ import annotations

from typing import Any

import numpy as np

CARRIED = 0.01  # a term counts on a joint where it carries more than this share of the joint's torque variance
TERMS = ("torque", "inertial", "coriolis", "gravity")


def parts(model: Any, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> dict[str, np.ndarray]:
    """Torque and its three parts, each (n, dof) [N m]; `torque` is the model's whole output, ε included."""
    return {
        "torque": model.inverse_dynamics(q, v, a),
        "inertial": np.einsum("nij,nj->ni", model.mass_matrix(q), a),
        "coriolis": model.coriolis_torque(q, v),
        "gravity": model.gravity_torque(q),
    }


def term_errors(model: Any, reference: Any, motion: Any) -> dict[str, Any]:
    """Normalised mean squared error of each term on each joint; None where the joint does not carry the term.

    Also the relative Frobenius error of the mass matrix and its smallest eigenvalue over the motion.
    """
    found, true = parts(model, motion.q, motion.v, motion.a), parts(reference, motion.q, motion.v, motion.a)
    whole = true["torque"].var(axis=0)
    out: dict[str, Any] = {}
    for term in TERMS:
        power = true[term].var(axis=0)
        error = np.mean((found[term] - true[term]) ** 2, axis=0)
        out[term] = [float(e / p) if p > CARRIED * w else None for e, p, w in zip(error, power, whole, strict=True)]
    mass, true_mass = model.mass_matrix(motion.q), reference.mass_matrix(motion.q)
    out["mass_matrix"] = float(np.linalg.norm(mass - true_mass) / np.linalg.norm(true_mass))
    out["smallest_eigenvalue"] = float(np.linalg.eigvalsh(0.5 * (mass + mass.transpose(0, 2, 1))).min())
    return out


def median_errors(found: list[dict[str, Any]]) -> dict[str, Any]:
    """Median over seeds of the output of `term_errors`."""
    out: dict[str, Any] = {}
    for term in TERMS:
        columns = zip(*(f[term] for f in found), strict=True)
        out[term] = [None if None in column else float(np.median(column)) for column in columns]
    out["mass_matrix"] = float(np.median([f["mass_matrix"] for f in found]))
    out["smallest_eigenvalue"] = float(min(f["smallest_eigenvalue"] for f in found))
    return out
