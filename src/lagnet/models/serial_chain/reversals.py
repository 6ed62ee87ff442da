"""How sharply the dry friction of a learned arm changes sign."""

from __future__ import annotations

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from lagnet.models.learned_model import LearnedModel
from lagnet.models.serial_chain.model import SerialChain
from lagnet.types import Trajectory

WIDTHS = np.geomspace(1.0, 1e-3, 13)  # of the speed that the search assumed
DRY = "coulomb_friction"


def sharpen_reversals(chain: SerialChain, q: Trajectory, v: Trajectory, a: Trajectory, tau: Trajectory) -> SerialChain:
    """The same arm, each joint's friction changing sign over the speeds that leave least of the torque.

    The search of an arm needs a smooth law and one width for all; simulators differ in theirs, many have a step.

    Args:
        chain: a learned arm; given back as it is where its joints have no dry friction.
        q, v, a: shape (n, dof), motion with its reversals [rad, rad/s, rad/s²] ([m …] for prismatic joints).
        tau: shape (n, dof), torque [N m] ([N]).
    """
    dynamics = chain.dynamics
    if DRY not in dynamics.joint_terms:
        return chain
    size = np.asarray(dynamics.coefficients)[dynamics.joint_terms.index(DRY)]
    assumed = np.asarray(dynamics.slow_speed, dtype=float)
    smooth = tau - chain.inverse_dynamics(q, v, a) + size * np.tanh(v / assumed)
    left = [np.mean((smooth - size * np.tanh(v / (width * assumed))) ** 2, axis=0) for width in WIDTHS]
    speed = WIDTHS[np.argmin(left, axis=0)] * assumed
    with jax.enable_x64(True):
        sharp = eqx.tree_at(lambda d: d.slow_speed, dynamics, jnp.asarray(speed))
    return SerialChain(LearnedModel(chain.spec, sharp, chain.training))
