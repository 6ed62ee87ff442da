"""A model's torque, term by term, along a motion."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from lagnet.decomposition.offers import offers
from lagnet.types import Samples, Trajectory

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


def terms_of(
    model: Any,
    q: Trajectory,
    v: Trajectory,
    a: Trajectory,
    time: Samples | None = None,
    trajectory: np.ndarray | None = None,
) -> Terms:
    """Split the torque of any model with the InverseDynamics calls.

    What a model calls its residual is taken from `residual_torque`; a model without one has as residual whatever its
    inverse dynamics hold beyond H a + c + g, down to rounding, which is set to zero. Where the samples have a time, a
    model with memory (`torque_along`) is asked for its torque along each motion.

    Args:
        model: see lagnet.types.InverseDynamics.
        q, v, a: shape (n, dof), motion.
        time: shape (n,), [s], or None for samples that stand for themselves.
        trajectory: shape (n,), label of the motion that a sample is in, one motion if None.
    """
    rows = [slice(k, k + CHUNK) for k in range(0, max(len(q), 1), CHUNK)]
    parts = [_mechanics(model, q[r], v[r], a[r]) for r in rows]
    inertial, coriolis, gravity = (np.concatenate(p) for p in zip(*parts, strict=True))
    if time is not None and len(time) and offers(model, "torque_along"):
        total = _along(model, time, trajectory, q, v, a)
    elif offers(model, "residual_torque"):
        rest = [np.asarray(model.residual_torque(q[r], v[r], a[r]), dtype=float) for r in rows]
        return Terms(inertial, coriolis, gravity, np.concatenate(rest))
    else:
        total = np.concatenate([np.asarray(model.inverse_dynamics(q[r], v[r], a[r]), dtype=float) for r in rows])
    rest = total - inertial - coriolis - gravity
    rounding = 1e-12 * (np.abs(inertial) + np.abs(coriolis) + np.abs(gravity)).max(initial=0.0)
    return Terms(inertial, coriolis, gravity, np.where(np.abs(rest) <= rounding, 0.0, rest))


def _mechanics(model: Any, q: Trajectory, v: Trajectory, a: Trajectory) -> tuple[Trajectory, Trajectory, Trajectory]:
    inertial = np.einsum("nij,nj->ni", np.asarray(model.mass_matrix(q), dtype=float), a)
    coriolis = np.asarray(model.coriolis_torque(q, v), dtype=float)
    return inertial, coriolis, np.asarray(model.gravity_torque(q), dtype=float)


def _along(
    model: Any, time: Samples, trajectory: np.ndarray | None, q: Trajectory, v: Trajectory, a: Trajectory
) -> Trajectory:
    """Torque of a model with memory, motion by motion."""
    edges = [] if trajectory is None else (np.flatnonzero(np.diff(trajectory)) + 1).tolist()
    motions = zip([0, *edges], [*edges, len(time)], strict=True)
    return np.concatenate([np.asarray(model.torque_along(*(x[i:j] for x in (time, q, v, a)))) for i, j in motions])
