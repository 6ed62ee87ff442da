"""What a Lagrangian model must say: kinetic energy, potential energy, and the momentum that goes with them.

Calls here take one sample (dof,) and are pure JAX, so that they can be batched, compiled and differentiated;
`lagnet.models.learned_model.LearnedModel` is the NumPy side.
"""

from __future__ import annotations

from abc import abstractmethod

import equinox as eqx
from jaxtyping import Array, Float

Vector = Float[Array, " dof"]
Matrix = Float[Array, "dof dof"]
Scalar = Float[Array, ""]


class AbstractLagrangian(eqx.Module):
    """An arm as two energies of its state: L(q, v) = T(q, v) − V(q)."""

    @abstractmethod
    def kinetic_energy(self, q: Vector, v: Vector) -> Scalar:
        """Energy of motion T(q, v) [J]; zero at rest."""

    @abstractmethod
    def potential_energy(self, q: Vector) -> Scalar:
        """Energy of position V(q) [J], up to a constant."""

    @abstractmethod
    def momentum(self, q: Vector, v: Vector) -> Vector:
        """Joint momentum p = ∂L/∂v [N m s], given in closed form where T allows it."""

    @abstractmethod
    def inverse_dynamics(self, q: Vector, v: Vector, a: Vector) -> Vector:
        """Torque [N m] that follows from both energies: `euler_lagrange.inverse_dynamics`, or the same by hand."""

    @abstractmethod
    def mass_matrix(self, q: Vector) -> Matrix:
        """Joint-space inertia ∂p/∂v at rest, shape (dof, dof) [kg m²]."""
