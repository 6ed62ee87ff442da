"""The identified layer: torque that recordings determine without saying which cause it has."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.effects.motion import Motion
from lagnet.errors import ModelError
from lagnet.models.corrected.motion_terms import INERTIA, MotionTerm, Rest
from lagnet.rigid_body.changed_bodies_torque import torque_of_change
from lagnet.types import RigidBodyModel, Trajectory


@dataclass(frozen=True, eq=False)
class IdentifiedLayer:
    """Changes of all bodies and weighted functions of motion, on top of the named physics.

    Args:
        bodies: shape (dof, 10), change of the inertial parameters of each link; None where the nominal model has no
            bodies.
        terms: the functions of motion.
        weights: shape (n_terms,), torque per unit of each.
        rest: when joints rest, and what of their dry friction stays.
    """

    bodies: np.ndarray | None
    terms: tuple[MotionTerm, ...]
    weights: np.ndarray
    rest: Rest

    def body_torque(self, model: RigidBodyModel | None, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """Torque of the changed bodies alone, Y(q, v, a) Δπ, shape (n, dof) [N m].

        Args:
            model: gives the regressor Y; None for a nominal model without bodies.

        Raises:
            ModelError: bodies change, and there are none.
        """
        if self.bodies is None or not self.bodies.any():
            return np.zeros(np.shape(q))
        if model is None:
            raise ModelError("the nominal model has no bodies that an identified layer could change")
        return torque_of_change(model, self.bodies, q, v, a)

    def term_torque(self, motion: Motion, load: Trajectory, ordered: bool = True) -> Trajectory:
        """Torque of the functions of motion, shape (n, dof) [N m].

        Args:
            motion: the samples.
            load: shape (n, dof), torque of the bodies, named and identified changes included [N m].
            ordered: whether the samples follow each other on an even clock.
        """
        out = np.zeros(np.shape(load))
        rest = self.rest if ordered else None
        for term, weight in zip(self.terms, self.weights, strict=True):
            for row in term.rows if weight else ():
                out[:, row] += weight * term.at(row, motion, load, rest)
        return out

    def of_kind(self, kind: str, joint: int) -> list[tuple[MotionTerm, float]]:
        """The functions of a kind at one joint with their weights."""
        pairs = zip(self.terms, self.weights, strict=True)
        return [(t, float(w)) for t, w in pairs if (t.kind, t.joint, t.other) == (kind, joint, None)]

    def joint_inertia(self, n_dof: int) -> np.ndarray:
        """What rotors and ties add to the mass matrix, shape (dof, dof) [kg m²]."""
        out = np.zeros((n_dof, n_dof))
        for term, weight in zip(self.terms, self.weights, strict=True):
            if term.kind in INERTIA:
                other = term.joint if term.other is None else term.other
                out[term.joint, other] = out[other, term.joint] = out[term.joint, other] + weight
        return out
