"""A serial arm found from torque as its users see it: NumPy arrays in SI units, and the regressors of its links.

Frames are the model's own: link i's origin lies on its joint's axis, and the base's z axis along joint 0. With turning
joints alone the unit of length is fixed by the size of gravity.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import final

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from lagnet.errors import ModelError
from lagnet.models.features import fit_features
from lagnet.models.files.saving import load_model
from lagnet.models.kinds import ModelSpec
from lagnet.models.learned_model import LearnedModel
from lagnet.models.scales import fit_scales
from lagnet.models.serial_chain.dynamics import SerialChainDynamics
from lagnet.models.serial_chain.identification.fit import SerialChainFit, fit_serial_chain
from lagnet.models.serial_chain.mechanics.inertia import regressor_to_standard, to_standard
from lagnet.models.serial_chain.mechanics.kinematics import Geometry
from lagnet.models.serial_chain.mechanics.newton_euler import SerialArm, moment_regressor
from lagnet.models.serial_chain.settings import SerialChainSettings
from lagnet.types import MassMatrix, Trajectory

KIND = "serial-chain"
CHUNK = 1000  # samples of a regressor at a time


@final
class SerialChain:
    """Dynamics of a serial arm whose constants were found from torque; an `InverseDynamics`.

    Args:
        learned: the same model as any learned one, which computes and saves it.
    """

    compiles = LearnedModel.compiles

    def __init__(self, learned: LearnedModel):
        if not isinstance(learned.dynamics, SerialChainDynamics):
            raise ModelError(f"a model of kind {learned.model_kind} is not a serial chain")
        self.learned, self.dynamics = learned, learned.dynamics
        self.kind, self.source, self.sha256 = learned.kind, learned.source, learned.sha256

    @property
    def joints(self) -> tuple[str, ...]:
        """Joint names in model order."""
        return self.learned.joints

    @property
    def joint_types(self) -> tuple[str, ...]:
        """'revolute', 'continuous' or 'prismatic' for each joint."""
        return self.learned.joint_types

    @property
    def n_dof(self) -> int:
        """Number of joints."""
        return self.learned.n_dof

    @property
    def model_kind(self) -> str:
        """The kind of learned model this is."""
        return self.learned.model_kind

    @property
    def spec(self) -> ModelSpec:
        """All that the model is, but for its constants."""
        return self.learned.spec

    @property
    def training(self) -> dict:
        """What the fit said about itself; plain values."""
        return self.learned.training

    @property
    def gravity(self) -> np.ndarray:
        """Free fall in the model's base frame, shape (3,) [m/s²]."""
        return np.array(self.dynamics.lagrangian.geometry.gravity)

    @property
    def inertial_parameters(self) -> np.ndarray:
        """Mass, first moments and rotational inertia of each link in its own frame, shape (dof, 10)."""
        return to_standard(np.asarray(self.dynamics.lagrangian.moments))

    def inverse_dynamics(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """Torque [N m] that gives acceleration a at (q, v), joint terms included, shape (n, dof)."""
        return self.learned.inverse_dynamics(q, v, a)

    def forward_dynamics(self, q: Trajectory, v: Trajectory, tau: Trajectory) -> Trajectory:
        """Acceleration [rad/s²] that torque tau gives at (q, v), shape (n, dof)."""
        return self.learned.forward_dynamics(q, v, tau)

    def mass_matrix(self, q: Trajectory) -> MassMatrix:
        """Joint-space inertia H(q), shape (n, dof, dof)."""
        return self.learned.mass_matrix(q)

    def coriolis_matrix(self, q: Trajectory, v: Trajectory) -> MassMatrix:
        """Christoffel matrix C(q, v) of H, shape (n, dof, dof)."""
        return self.learned.coriolis_matrix(q, v)

    def coriolis_torque(self, q: Trajectory, v: Trajectory) -> Trajectory:
        """Centrifugal and Coriolis torques c(q, v), shape (n, dof) [N m]."""
        return self.learned.coriolis_torque(q, v)

    def gravity_torque(self, q: Trajectory) -> Trajectory:
        """Torque that holds the rigid arm still, shape (n, dof) [N m]."""
        return self.learned.gravity_torque(q)

    def residual_torque(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """Friction, offsets and springs of the joints, zero without such terms, shape (n, dof) [N m]."""
        return self.learned.residual_torque(q, v, a)

    def kinetic_energy(self, q: Trajectory, v: Trajectory) -> np.ndarray:
        """Energy of motion, shape (n,) [J]."""
        return self.learned.kinetic_energy(q, v)

    def potential_energy(self, q: Trajectory) -> np.ndarray:
        """Energy of position of the rigid arm, up to a constant, shape (n,) [J]."""
        return self.learned.potential_energy(q)

    def joint_torque_regressor(self, q: Trajectory, v: Trajectory, a: Trajectory) -> np.ndarray:
        """Torque per unit of each inertial parameter at the shape found, shape (n, dof, 10 dof)."""
        given = [np.asarray(x, dtype=float) for x in (q, v, a)]
        with jax.enable_x64(True):
            arm = self.dynamics.lagrangian
            parts = [np.asarray(_regressors(arm.geometry, arm.revolute, *rows)) for rows in _pieces(given)]
        columns = np.concatenate(parts)[: len(given[0])]
        shaped = columns.reshape(*columns.shape[:2], self.n_dof, 10)
        return regressor_to_standard(shaped).reshape(columns.shape)

    def link_regressor(self, joint: int, q: Trajectory, v: Trajectory, a: Trajectory) -> np.ndarray:
        """Torque per unit of the inertial parameters of the link behind one joint, shape (n, dof, 10)."""
        k = joint % self.n_dof
        return self.joint_torque_regressor(q, v, a)[:, :, 10 * k : 10 * k + 10]

    def weight_regressor(self, joint: int, q: Trajectory) -> np.ndarray:
        """Holding torque per unit of gravity along each axis and each parameter of one link, shape (3, n, dof, 10)."""
        still = np.zeros_like(q)
        return np.stack([self.with_gravity(axis).link_regressor(joint, q, still, still) for axis in np.eye(3)])

    def gravity_regressor(self, q: Trajectory) -> np.ndarray:
        """Torque per unit of gravity along the axes of the model's base frame, shape (n, dof, 3) [N m s²/m]."""
        return np.stack([self.with_gravity(axis).gravity_torque(q) for axis in np.eye(3)], axis=-1)

    def with_gravity(self, gravity: np.ndarray) -> SerialChain:
        """The same arm mounted otherwise; gravity of shape (3,) in the model's base frame [m/s²]."""
        gravity = np.asarray(gravity, dtype=np.asarray(self.dynamics.lagrangian.moments).dtype)
        if gravity.shape != (3,):
            raise ValueError(f"gravity has shape {gravity.shape}, expected (3,)")
        with jax.enable_x64(True):
            pulled = eqx.tree_at(lambda d: d.lagrangian.geometry.gravity, self.dynamics, jnp.asarray(gravity))
        return SerialChain(LearnedModel(self.learned.spec, pulled, self.learned.training))

    def save(self, folder: str | Path) -> Path:
        """Write the model to a folder, without pickle; see `lagnet.models.files.saving`."""
        return self.learned.save(folder)


def learn_serial_chain(
    q: Trajectory,
    v: Trajectory,
    a: Trajectory,
    tau: Trajectory,
    joints: Sequence[str],
    joint_types: Sequence[str],
    seed: int = 0,
    settings: SerialChainSettings | None = None,
) -> tuple[SerialChain, SerialChainFit]:
    """Find a serial arm from torque, and give it as a model together with what the fit says of itself.

    Arguments and errors are those of `fit_serial_chain`; joints are names in the order of the columns.
    """
    settings = settings or SerialChainSettings()
    found = fit_serial_chain(q, v, a, tau, joint_types, seed, settings)
    features = fit_features(np.asarray(q, dtype=float), tuple(joint_types))
    settings = replace(settings, joint_terms=found.unknowns.joint_terms)  # those that the torque asked for
    spec = ModelSpec(KIND, settings, tuple(joints), features, fit_scales(np.asarray(v), np.asarray(a), np.asarray(tau)))
    with jax.enable_x64(True):
        dynamics = _dynamics(found)
    return SerialChain(LearnedModel(spec, dynamics, _about(found, seed))), found


def load_serial_chain(folder: str | Path, n_dof: int | None = None) -> SerialChain:
    """Read a serial chain that `save` wrote.

    Raises:
        ModelError: no model there, damaged, from a newer format, for another number of joints, or of another kind.
    """
    return SerialChain(load_model(folder, n_dof))


@partial(jax.jit, static_argnums=1)
def _regressors(
    geometry: Geometry,
    revolute: tuple[bool, ...],
    q: Float[Array, "n dof"],
    v: Float[Array, "n dof"],
    a: Float[Array, "n dof"],
):
    """Regressors of a batch; compiled once for arms of the same joints, whatever their shape and gravity."""
    return jax.vmap(lambda *s: moment_regressor(geometry, revolute, *s))(q, v, a)


def _dynamics(found: SerialChainFit) -> SerialChainDynamics:
    """The constants found, as a model."""
    terms = dict(zip(found.unknowns.joint_terms, found.coefficients, strict=True))
    rotor = jnp.asarray(terms.pop("rotor_inertia", np.zeros(found.unknowns.n_dof)))
    names = tuple(terms)
    beside = jnp.asarray(np.array([terms[name] for name in names]).reshape(-1, found.unknowns.n_dof))
    geometry = found.unknowns.geometry(jnp.asarray(found.x))
    arm = SerialArm(geometry, jnp.asarray(found.moments), rotor, found.unknowns.revolute)
    return SerialChainDynamics(arm, beside, jnp.asarray(found.unknowns.slow_speed), names)


def _about(found: SerialChainFit, seed: int) -> dict:
    """What a saved model says about its fit, in plain values."""
    return {
        "seed": seed,
        "held_out_error": found.nmse.tolist(),
        "physical": found.physical,
        "noise": found.noise.tolist(),
        "base_rank": found.determinacy.base_rank,
        "shape_rank": found.determinacy.shape_rank,
        "determined": found.determinacy.determined.tolist(),
    }


def _pieces(given: list[np.ndarray]):
    """Samples in pieces of one size, the last padded, so that one shape is compiled."""
    n = len(given[0])
    size = min(CHUNK, n)
    for first in range(0, n, size):
        rows = [x[first : first + size] for x in given]
        yield [np.pad(x, ((0, size - len(x)), (0, 0)), mode="edge") for x in rows]
