"""DeLaN-FFNN and its kin: τ = H a + c + g + ε(q, v, a), any dynamics with a network for what mechanics cannot be.

Mechanics without losses runs backwards as well as forwards: H a + c + g are the same for v and −v. The part of ε that
is odd in v can therefore never be conservative torque; the even part can.
Source: Wu et al. 2024, eqs 9–12.
"""

from __future__ import annotations

from typing import Any

import equinox as eqx

from lagnet.models.dynamics import AbstractDynamics, solve_for_acceleration
from lagnet.models.lagrangians.lagrangian import Matrix, Vector

PARITIES = ("any", "odd")


class Augmented(AbstractDynamics):
    """Mechanics plus ε.

    Args:
        mechanics: gives H, c and g.
        residual: the network behind ε, called with (q, v, a); a subclass may call it otherwise.
        parity: "any", or "odd" to keep only the part of ε that changes sign with the velocity.
    """

    mechanics: AbstractDynamics
    residual: Any
    parity: str = eqx.field(static=True)

    def epsilon(self, q: Vector, v: Vector, a: Vector) -> Vector:
        """ε(q, v, a), shape (dof,) [N m]."""
        forwards = self.residual(q, v, a)
        return 0.5 * (forwards - self.residual(q, -v, a)) if self.parity == "odd" else forwards

    def inverse_dynamics(self, q: Vector, v: Vector, a: Vector) -> Vector:
        return self.mechanics.inverse_dynamics(q, v, a) + self.epsilon(q, v, a)

    def forward_dynamics(self, q: Vector, v: Vector, tau: Vector) -> Vector:
        return solve_for_acceleration(lambda a: self.inverse_dynamics(q, v, a), tau)

    def mass_matrix(self, q: Vector) -> Matrix:
        return self.mechanics.mass_matrix(q)

    def coriolis_matrix(self, q: Vector, v: Vector) -> Matrix:
        return self.mechanics.coriolis_matrix(q, v)

    def coriolis_torque(self, q: Vector, v: Vector) -> Vector:
        return self.mechanics.coriolis_torque(q, v)

    def gravity_torque(self, q: Vector) -> Vector:
        return self.mechanics.gravity_torque(q)

    def residual_torque(self, q: Vector, v: Vector, a: Vector) -> Vector:
        return self.mechanics.residual_torque(q, v, a) + self.epsilon(q, v, a)
