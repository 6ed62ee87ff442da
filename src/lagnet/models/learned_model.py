"""A learned model as its users see it: NumPy arrays in SI units in and out, batch first, float64."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from functools import cache, partial
from pathlib import Path
from typing import Any, final

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from lagnet.errors import ModelError
from lagnet.models.devices import chosen_devices
from lagnet.models.dynamics import AbstractDynamics
from lagnet.models.kinds import ModelSpec
from lagnet.models.lagrangians.conservative import Conservative, FreeLagrangian
from lagnet.models.networks import OrderedNetwork
from lagnet.models.one_sample import torque_of_one
from lagnet.models.residuals.augmented import Augmented
from lagnet.models.serial_chain.dynamics import SerialChainDynamics
from lagnet.types import MassMatrix, Samples, Trajectory

CHUNK = 512  # samples computed at a time: the working set stays in cache, memory stays bounded
LARGE = 16 * CHUNK, 256 * CHUNK  # elsewhere than on a processor: thousands of threads want as many samples
BUCKETS = (1, 8, 32, CHUNK)  # batches are padded to one of these, so that few shapes are ever compiled
THREADS = min(os.cpu_count() or 1, 16)  # chunks computed side by side
PRECISIONS = {"double": np.float64, "single": np.float32}


@final
class LearnedModel:
    """Inverse and forward dynamics of a trained model, and its parts; an `InverseDynamics`.

    Args:
        spec: kind, settings, joints, features and scales.
        dynamics: the weights.
        training: what the training says about itself (seed, data checksums, versions, errors); plain values.
        source: folder it was read from; sha256: checksum of the weights there.
        precision: "double", or "single" to compute in float32; arrays in and out are float64 all the same.
    """

    compiles = True  # a batch of a new size may take a second the first time

    def __init__(
        self,
        spec: ModelSpec,
        dynamics: AbstractDynamics,
        training: Mapping[str, Any] | None = None,
        source: str = "",
        sha256: str = "",
        precision: str = "double",
    ):
        if precision not in PRECISIONS:
            raise ModelError(f"precision {precision!r} is unknown", choices=PRECISIONS)
        self.spec, self.training, self.source, self.sha256 = spec, dict(training or {}), source, sha256
        self.kind, self.joints, self.joint_types = "learned", spec.joints, spec.joint_types
        self.model_kind, self.precision = spec.kind, precision
        with jax.enable_x64(True):
            self.dynamics: AbstractDynamics = jax.tree.map(_wide, dynamics)
        self._functions: dict[tuple[str, bool], Callable[..., np.ndarray]] = {}

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

    def in_single_precision(self) -> LearnedModel:
        """The same model computing in float32: faster in batches, torque to about 1e-5 of its size."""
        return LearnedModel(self.spec, self.dynamics, self.training, self.source, self.sha256, "single")

    def save(self, folder: str | Path) -> Path:
        """Write the model to a folder, without pickle; see `lagnet.models.files.saving`."""
        from lagnet.models.files.saving import save_model

        return save_model(self, folder)

    def _mechanics(self) -> Conservative | FreeLagrangian | SerialChainDynamics:
        dynamics = self.dynamics.mechanics if isinstance(self.dynamics, Augmented) else self.dynamics
        if not isinstance(dynamics, Conservative | FreeLagrangian | SerialChainDynamics):
            raise ModelError(f"a model of kind {self.model_kind} has no energies", choices=("delan", "delan-ffnn"))
        return dynamics

    def _function(self, name: str, alone: bool) -> Callable[..., np.ndarray]:
        """One call, for batches or for a sample alone: compiled, or in NumPy where that is sooner done."""
        width = PRECISIONS[self.precision]
        owner: Any = self._mechanics().lagrangian if name.endswith("_energy") else self.dynamics
        with self._width():
            owner = _settled(owner, width)
            by_hand = torque_of_one(owner, width) if alone and name == "inverse_dynamics" else None
            if by_hand is not None:
                return by_hand
            compiled = _compiled(owner, name, alone)

        def call(*given: np.ndarray) -> np.ndarray:
            with self._width():
                return np.array(compiled(*given), np.float64)

        return call

    def _batched(self, name: str, **arrays: Any) -> np.ndarray:
        given = self._checked(arrays)
        n, device = len(given[0]), chosen_devices()[0]
        key = (name, n == 1)
        function = self._functions.get(key) or self._functions.setdefault(key, self._function(*key))
        if n in BUCKETS:
            return function(*given)
        buckets = BUCKETS if device.platform == "cpu" else (*BUCKETS, *LARGE)
        chunk = buckets[-1]
        parts = [[x[i : i + chunk] for x in given] for i in range(0, n, chunk)]
        padded = partial(_padded, function, buckets, device)
        return np.concatenate([*(map if n <= chunk else _workers().map)(padded, parts)])

    def _width(self) -> Any:
        """Whether JAX computes in float64; a setting of the thread."""
        return jax.enable_x64(self.precision == "double")

    def _checked(self, arrays: Mapping[str, Any]) -> list[np.ndarray]:
        wanted = PRECISIONS[self.precision]
        out = [np.asarray(x, dtype=wanted) for x in arrays.values()]
        for name, x in zip(arrays, out, strict=True):
            if x.ndim != 2 or x.shape[1] != self.n_dof or x.shape != out[0].shape:
                raise ValueError(
                    f"{name} has shape {x.shape}, expected (n_samples, {self.n_dof}) and as many samples throughout"
                )
        return out


@cache
def _workers() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(THREADS, thread_name_prefix="lagnet-model")


def _compiled(owner: Any, name: str, alone: bool) -> Callable[..., Any]:
    """The compiled version of one call of a settled model.

    Weights are given to it as a list, since walking through the model at every call would take longer than one sample.
    Into the call for a sample alone they are built, which saves handing them over; but not where some are all zero,
    such as those of an ε that stays silent: XLA folds a product of 4096 rows with such weights away and adds memory
    that it never wrote (jax 0.10.2 on CPU).
    """
    weights, rest = eqx.partition(owner, eqx.is_array)
    leaves, tree = jax.tree.flatten(weights)

    def call(leaves: list[Any], *given: Any) -> Any:
        with jax.default_matmul_precision("float32"):  # a GPU would round products of single precision to ten bits
            return jax.vmap(getattr(eqx.combine(tree.unflatten(leaves), rest), name))(*given)

    if alone and all(np.any(x) for x in leaves if x.ndim > 1):
        return jax.jit(partial(call, leaves))
    return partial(jax.jit(call), leaves)


def _padded(
    function: Callable[..., np.ndarray], buckets: tuple[int, ...], device: Any, arrays: list[np.ndarray]
) -> np.ndarray:
    n = len(arrays[0])
    size = next(bucket for bucket in buckets if bucket >= n)
    if size > n:
        arrays = [np.pad(x, ((0, size - n), (0, 0)), mode="edge") for x in arrays]
    with jax.default_device(device):  # a setting of the thread, which workers do not inherit
        return function(*arrays)[:n]


def _settled(owner: Any, width: Any) -> Any:
    """The model as it is called: in its precision, what training needs left out."""

    narrow = jax.tree.map(lambda x: jnp.asarray(np.asarray(x, width)) if eqx.is_array(x) else x, owner)
    return jax.tree.map(_ready, narrow, is_leaf=lambda x: isinstance(x, OrderedNetwork))


def _ready(part: Any) -> Any:
    return part.settled() if isinstance(part, OrderedNetwork) else part


def _wide(leaf: Any) -> Any:
    return jnp.asarray(leaf, jnp.float64) if eqx.is_array(leaf) else leaf
