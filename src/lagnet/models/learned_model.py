"""A learned model as its users see it: NumPy arrays in SI units in and out, batch first, float64."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any, final

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from lagnet.errors import ModelError
from lagnet.models.augmented import Augmented
from lagnet.models.conservative import Conservative, FreeLagrangian
from lagnet.models.dynamics import AbstractDynamics
from lagnet.models.kinds import ModelSpec
from lagnet.models.serial_chain.dynamics import SerialChainDynamics
from lagnet.types import MassMatrix, Samples, Trajectory

CHUNK = 4096  # samples computed at a time: the working set stays in cache, memory stays bounded
BUCKETS = (1, 8, 32, 512, CHUNK)  # batches are padded to one of these, so that few shapes are ever compiled


@final
class LearnedModel:
    """Inverse and forward dynamics of a trained model, and its parts; an `InverseDynamics`.

    Args:
        spec: kind, settings, joints, features and scales.
        dynamics: the weights.
        training: what the training says about itself (seed, data checksums, versions, errors); plain values.
        source: folder it was read from; sha256: checksum of the weights there.
    """

    compiles = True  # a batch of a new size may take a second the first time

    def __init__(
        self,
        spec: ModelSpec,
        dynamics: AbstractDynamics,
        training: Mapping[str, Any] | None = None,
        source: str = "",
        sha256: str = "",
    ):
        self.spec, self.training, self.source, self.sha256 = spec, dict(training or {}), source, sha256
        self.kind, self.joints, self.joint_types = "learned", spec.joints, spec.joint_types
        self.model_kind = spec.kind
        with jax.enable_x64(True):
            self.dynamics: AbstractDynamics = jax.tree.map(_wide, dynamics)
        self._compiled: dict[str, Callable[..., Any]] = {}

    def __repr__(self) -> str:
        return f"LearnedModel({self.model_kind}, {self.n_dof} joints: {', '.join(self.joints)})"

    @property
    def n_dof(self) -> int:
        """Number of joints."""
        return len(self.joints)

    def inverse_dynamics(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """Torque [N m] that gives acceleration a at (q, v), ε included, shape (n, dof)."""
        return self._batched("inverse_dynamics", q=q, v=v, a=a)

    def forward_dynamics(self, q: Trajectory, v: Trajectory, tau: Trajectory) -> Trajectory:
        """Acceleration [rad/s²] that torque tau gives at (q, v), shape (n, dof)."""
        return self._batched("forward_dynamics", q=q, v=v, tau=tau)

    def mass_matrix(self, q: Trajectory) -> MassMatrix:
        """Joint-space inertia H(q), shape (n, dof, dof)."""
        return self._batched("mass_matrix", q=q)

    def coriolis_matrix(self, q: Trajectory, v: Trajectory) -> MassMatrix:
        """Christoffel matrix C(q, v) of H, with Ḣ = C + Cᵀ, shape (n, dof, dof)."""
        return self._batched("coriolis_matrix", q=q, v=v)

    def coriolis_torque(self, q: Trajectory, v: Trajectory) -> Trajectory:
        """Centrifugal and Coriolis torques c(q, v), shape (n, dof) [N m]."""
        return self._batched("coriolis_torque", q=q, v=v)

    def gravity_torque(self, q: Trajectory) -> Trajectory:
        """Torque that holds the arm still, shape (n, dof) [N m]."""
        return self._batched("gravity_torque", q=q)

    def residual_torque(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """What H a + c + g leave of the whole torque: ε of eq. 11, shape (n, dof) [N m]."""
        return self._batched("residual_torque", q=q, v=v, a=a)

    def kinetic_energy(self, q: Trajectory, v: Trajectory) -> Samples:
        """Energy of motion, shape (n,) [J].

        Raises:
            ModelError: the model knows no energies.
        """
        self._mechanics()
        return self._batched("kinetic_energy", q=q, v=v)

    def potential_energy(self, q: Trajectory) -> Samples:
        """Energy of position, up to a constant, shape (n,) [J].

        Raises:
            ModelError: the model knows no energies.
        """
        self._mechanics()
        return self._batched("potential_energy", q=q)

    def save(self, folder: str | Path) -> Path:
        """Write the model to a folder, without pickle; see `lagnet.models.saving`."""
        from lagnet.models.saving import save_model

        return save_model(self, folder)

    def _mechanics(self) -> Conservative | FreeLagrangian | SerialChainDynamics:
        dynamics = self.dynamics.mechanics if isinstance(self.dynamics, Augmented) else self.dynamics
        if not isinstance(dynamics, Conservative | FreeLagrangian | SerialChainDynamics):
            raise ModelError(f"a model of kind {self.model_kind} has no energies", choices=("delan", "delan-ffnn"))
        return dynamics

    def _function(self, name: str) -> Callable[..., Any]:
        """The compiled batch version of one call.

        Weights are given to it, not built in: with weights that are exactly zero, such as those of an ε that stays
        silent, XLA folds a product of 4096 rows away and adds memory that it never wrote (jax 0.10.2 on CPU).
        """
        if name not in self._compiled:
            owner: Any = self._mechanics().lagrangian if name.endswith("_energy") else self.dynamics
            weights, rest = eqx.partition(owner, eqx.is_array)

            def call(weights: Any, *given: Any) -> Any:
                return jax.vmap(getattr(eqx.combine(weights, rest), name))(*given)

            self._compiled[name] = partial(jax.jit(call), weights)
        return self._compiled[name]

    def _batched(self, name: str, **arrays: Any) -> np.ndarray:
        given = self._checked(arrays)
        n = len(given[0])
        with jax.enable_x64(True):
            function = self._function(name)
            if n in BUCKETS:
                return np.array(function(*given))
            parts = [self._padded(function, [x[i : i + CHUNK] for x in given]) for i in range(0, n, CHUNK)]
        return np.concatenate(parts)

    def _padded(self, function: Callable[..., Any], arrays: list[np.ndarray]) -> np.ndarray:
        n = len(arrays[0])
        size = next(bucket for bucket in BUCKETS if bucket >= n)
        full = [np.pad(x, ((0, size - n), (0, 0)), mode="edge") for x in arrays]
        return np.asarray(function(*full))[:n]

    def _checked(self, arrays: Mapping[str, Any]) -> list[np.ndarray]:
        out = [np.asarray(x, dtype=np.float64) for x in arrays.values()]
        for name, x in zip(arrays, out, strict=True):
            if x.ndim != 2 or x.shape[1] != self.n_dof or x.shape != out[0].shape:
                raise ValueError(
                    f"{name} has shape {x.shape}, expected (n_samples, {self.n_dof}) and as many samples throughout"
                )
        return out


def _wide(leaf: Any) -> Any:
    return jnp.asarray(leaf, jnp.float64) if eqx.is_array(leaf) else leaf
