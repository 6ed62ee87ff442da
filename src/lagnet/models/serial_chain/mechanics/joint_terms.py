"""What one joint adds to its own torque on a real arm, linear in its coefficient."""

from __future__ import annotations

from collections.abc import Sequence

import jax.numpy as jnp
from jaxtyping import Array

from lagnet.errors import ModelError

JOINT_TERMS = ("rotor_inertia", "viscous_friction", "coulomb_friction", "torque_offset", "joint_spring")
DISSIPATIVE_OR_MASSIVE = ("rotor_inertia", "viscous_friction", "coulomb_friction")  # never negative in a real joint


def check_joint_terms(names: Sequence[str]) -> tuple[str, ...]:
    """The same names, once known to be valid.

    Raises:
        ModelError: a name is unknown or stands twice.
    """
    for name in names:
        if name not in JOINT_TERMS:
            raise ModelError(f"joint term {name!r} is unknown", choices=JOINT_TERMS)
    if len(set(names)) < len(names):
        raise ModelError("a joint term stands twice", where=", ".join(names))
    return tuple(names)


def joint_term_columns(names: Sequence[str], slow_speed: Array, q: Array, v: Array, a: Array) -> Array:
    """Torque per unit of each term's coefficient: shape (dof, terms × dof), one diagonal block a term.

    Args:
        names: terms in the order of their coefficients.
        slow_speed: shape (dof,), speed over which Coulomb friction changes sign [rad/s].
        q, v, a: shape (dof,), one sample.
    """
    signals = {
        "rotor_inertia": a,
        "viscous_friction": v,
        "coulomb_friction": jnp.tanh(v / slow_speed),
        "torque_offset": jnp.ones_like(q),
        "joint_spring": q,
    }
    blocks = [jnp.diag(signals[name]) for name in names]
    return jnp.concatenate(blocks, axis=1) if blocks else jnp.zeros((q.shape[0], 0))
