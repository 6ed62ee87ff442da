"""A model's torque, term by term, along a motion."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from lagnet.types import Trajectory

TERMS = ("inertial", "coriolis", "gravity", "residual")
CHUNK = 4096  # samples at once: a mass matrix of a seven-joint arm takes 400 bytes a sample


@dataclass(frozen=True, eq=False)
class Terms:
    """Torque split by cause; total = inertial + coriolis + gravity + residual.

    Args:
        inertial: shape (n, dof), H(q) a [N m].
        coriolis: shape (n, dof), c(q, v) [N m].
        gravity: shape (n, dof), g(q) [N m].
        residual: shape (n, dof), what the model adds beyond mechanics, ε(q, v, a) [N m].
    """

    inertial: Trajectory
    coriolis: Trajectory
    gravity: Trajectory
    residual: Trajectory

    @property
    def total(self) -> Trajectory:
        """The model's torque, shape (n, dof) [N m]."""
        return self.inertial + self.coriolis + self.gravity + self.residual

    def items(self) -> Iterator[tuple[str, Trajectory]]:
        """The four terms and the total, by name."""
        for name in TERMS:
            yield name, getattr(self, name)
        yield "total", self.total


def terms_of(model: Any, q: Trajectory, v: Trajectory, a: Trajectory) -> Terms:
    """Split the torque of any model with the InverseDynamics calls.

    What a model calls its residual is taken from `residual_torque`; a model without one has as residual whatever its
    inverse dynamics hold beyond H a + c + g, down to rounding, which is set to zero.

    Args:
        model: see lagnet.types.InverseDynamics.
        q, v, a: shape (n, dof), motion.
    """
    pieces = [
        _split(model, q[k : k + CHUNK], v[k : k + CHUNK], a[k : k + CHUNK]) for k in range(0, max(len(q), 1), CHUNK)
    ]
    return Terms(*(np.concatenate([getattr(p, name) for p in pieces]) for name in TERMS))


def _split(model: Any, q: Trajectory, v: Trajectory, a: Trajectory) -> Terms:
    inertial = np.einsum("nij,nj->ni", np.asarray(model.mass_matrix(q), dtype=float), a)
    coriolis = np.asarray(model.coriolis_torque(q, v), dtype=float)
    gravity = np.asarray(model.gravity_torque(q), dtype=float)
    if callable(getattr(model, "residual_torque", None)):
        return Terms(inertial, coriolis, gravity, np.asarray(model.residual_torque(q, v, a), dtype=float))
    rest = np.asarray(model.inverse_dynamics(q, v, a), dtype=float) - inertial - coriolis - gravity
    rounding = 1e-12 * (np.abs(inertial) + np.abs(coriolis) + np.abs(gravity)).max(initial=0.0)
    return Terms(inertial, coriolis, gravity, np.where(np.abs(rest) <= rounding, 0.0, rest))
