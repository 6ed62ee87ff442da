"""The model under examination, called with care: one batch size, checked shapes, finite numbers, its own rounding."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from lagnet.decomposition.offers import offers
from lagnet.errors import ModelError
from lagnet.plausibility.ranges import Ranges, ranges_of
from lagnet.plausibility.settings import CheckSettings
from lagnet.recordings.recording import Recording
from lagnet.types import JointVector, MassMatrix, Trajectory

CALLS = ("inverse_dynamics", "mass_matrix", "coriolis_torque", "gravity_torque")
BATCH = 32  # the only batch size that a compiled model sees: it compiles once a call, not for every number of rows
COMPILING = 0.1, 5.0  # [s] and ratio by which a first call outlasts the second, if the model compiles
COARSEST_ROUNDING = 1e-6  # single precision; a model that is noisier gets no slack for it


class NotFinite(Exception):
    """The model gave a number that is not finite; carries the call and the configuration."""

    def __init__(self, call: str, where: dict[str, list[float]]):
        self.call, self.where = call, where
        super().__init__(call)


@dataclass(frozen=True, eq=False)
class Subject:
    """A model, what it is held against, and the motion it is meant for.

    Args:
        model: anything with the InverseDynamics calls.
        reference: a model that is believed, or None.
        recordings: what the robot did, possibly nothing.
        settings: limits and effort.
        seed: of every random draw.
    """

    model: Any
    reference: Any | None = None
    recordings: tuple[Recording, ...] = ()
    settings: CheckSettings = field(default_factory=CheckSettings)
    seed: int = 0
    _offered: dict[str, bool] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        require_calls(self.model)
        for name, other in (("reference", self.reference), *(("recording", r) for r in self.recordings)):
            if other is not None and len(other.joints) != len(self.model.joints):
                raise ModelError(
                    f"the {name} has {len(other.joints)} joints, the model {len(self.model.joints)}",
                    next_step="give one of the same arm, in the same joint order",
                )

    @property
    def n_dof(self) -> int:
        """Number of joints."""
        return self.model.n_dof

    @property
    def joints(self) -> Sequence[str]:
        """Joint names in model order."""
        return self.model.joints

    @cached_property
    def ranges(self) -> Ranges:
        """The box of motion that the model is meant for."""
        return ranges_of(self.model, self.reference, self.recordings)

    def offers(self, call: str) -> bool:
        """Whether the model has a call of its own beyond the four of InverseDynamics."""
        if call not in self._offered:
            self._offered[call] = offers(self.model, call)
        return self._offered[call]

    def torque(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """Total torque of the model, shape (n, dof)."""
        return self.call("inverse_dynamics", q, v, a)

    def residual(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """The torque ε that the model itself sets apart from mechanics, shape (n, dof); zero without one."""
        return self.call("residual_torque", q, v, a) if self.offers("residual_torque") else np.zeros_like(q)

    def mechanical_torque(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """Torque without ε, shape (n, dof)."""
        return self.torque(q, v, a) - self.residual(q, v, a)

    def mass_matrix(self, q: Trajectory) -> MassMatrix:
        """H(q), shape (n, dof, dof)."""
        return self.call("mass_matrix", q)

    def coriolis_torque(self, q: Trajectory, v: Trajectory) -> Trajectory:
        """c(q, v), shape (n, dof)."""
        return self.call("coriolis_torque", q, v)

    def gravity_torque(self, q: Trajectory) -> Trajectory:
        """g(q), shape (n, dof)."""
        return self.call("gravity_torque", q)

    def call(self, name: str, *arrays: Trajectory) -> np.ndarray:
        """One call of the model, in batches of one size if it compiles.

        Raises:
            ModelError: the call fails, or gives an array of another shape.
            NotFinite: it gives a number that is not finite.
        """
        out = self._in_batches(name, arrays) if self.compiles else self._answer(name, list(arrays))
        good = np.isfinite(out.reshape(len(out), -1)).all(axis=1)
        if not good.all():
            bad = int(np.flatnonzero(~good)[0])
            raise NotFinite(name, {s: array[bad].tolist() for s, array in zip("qva", arrays, strict=False)})
        return out

    @cached_property
    def compiles(self) -> bool:
        """Whether the model compiles anew for every shape of its arrays, as those in JAX do: seen by its first call."""
        rows, took = [np.repeat(x, BATCH, axis=0) for x in self.random(1, salt=14)], []
        for _ in range(2):
            begin = time.perf_counter()
            self._answer("inverse_dynamics", rows)
            took.append(time.perf_counter() - begin)
        least, ratio = COMPILING
        return took[0] > least and took[0] > ratio * took[1]

    def _in_batches(self, name: str, arrays: tuple[Trajectory, ...]) -> np.ndarray:
        pieces = []
        for start in range(0, len(arrays[0]), BATCH):
            rows = [array[start : start + BATCH] for array in arrays]
            short = BATCH - len(rows[0])
            padded = [np.concatenate([r, np.repeat(r[-1:], short, axis=0)]) for r in rows] if short else rows
            pieces.append(self._answer(name, padded)[: len(rows[0])])
        return np.concatenate(pieces)

    def _answer(self, name: str, arrays: list[np.ndarray]) -> np.ndarray:
        n, dof = arrays[0].shape
        try:
            out = np.asarray(getattr(self.model, name)(*arrays), dtype=float)
        except (TypeError, ValueError, IndexError, ArithmeticError, AttributeError) as error:
            raise ModelError(
                f"{name} failed on arrays of shape {arrays[0].shape}: {error}",
                where=type(self.model).__name__,
                next_step="the calls take NumPy arrays, batch first, and return one row a sample",
            ) from error
        if name in ("mass_matrix", "coriolis_matrix"):
            expected: tuple[int, ...] = (n, dof, dof)
        else:
            expected = (n,) if name in ("kinetic_energy", "potential_energy") else (n, dof)
        if out.shape != expected:
            raise ModelError(f"{name} gives shape {out.shape}, expected {expected}", where=type(self.model).__name__)
        return out

    def random(self, n: int, salt: int = 0) -> tuple[Trajectory, Trajectory, Trajectory]:
        """Random q, v, a of the box of motion, each of shape (n, dof)."""
        rng, box = np.random.default_rng([self.seed, salt]), self.ranges
        q = rng.uniform(box.lower, box.upper, (n, self.n_dof))
        v = rng.uniform(-box.velocity, box.velocity, (n, self.n_dof))
        return q, v, rng.uniform(-box.acceleration, box.acceleration, (n, self.n_dof))

    @cached_property
    def torque_scale(self) -> JointVector:
        """Typical torque of each joint, shape (dof,): what identities are measured against.

        Joints that carry hardly any torque are measured against a thousandth of the largest: their rounding comes from
        the forces that cancel in them.
        """
        q, v, a = self.random(128, salt=1)
        parts = np.abs(np.einsum("nij,nj->ni", self.mass_matrix(q), a))
        parts = parts + np.abs(self.coriolis_torque(q, v)) + np.abs(self.gravity_torque(q))
        typical = np.sqrt(np.mean(parts**2, axis=0))
        return np.maximum(typical, max(1e-3 * typical.max(), 1e-12))

    @cached_property
    def inertia_scale(self) -> JointVector:
        """Typical diagonal of H, shape (dof,)."""
        q, _, _ = self.random(128, salt=1)
        diagonal = np.abs(np.diagonal(self.mass_matrix(q), axis1=1, axis2=2)).mean(axis=0)
        return np.maximum(diagonal, max(1e-9 * diagonal.max(), 1e-15))

    @cached_property
    def rounding(self) -> float:
        """Relative rounding of the model's numbers: that of double precision, or of single where the model uses it.

        Fourth differences along a line of small steps leave only rounding (Moré and Wild 2011): their fourth power is
        below that of double precision, themselves they are above that of single.
        """
        q, v, a = self.random(8, salt=2)
        steps = np.arange(7)[:, None] * 3e-5
        found = []
        for k in range(len(q)):
            tau = self.torque(q[k] + steps, np.repeat(v[k : k + 1], 7, axis=0), np.repeat(a[k : k + 1], 7, axis=0))
            found.append(np.sqrt(np.mean(np.diff(tau, 4, axis=0) ** 2, axis=0) / 70.0) / self.torque_scale)
        return float(np.clip(np.median(np.max(found, axis=1)), 2.2e-16, COARSEST_ROUNDING))

    def at_least_rounding(self, limit: float, amplified: float = 1e3) -> float:
        """A limit for double precision, widened for models that compute in single."""
        return max(limit, amplified * self.rounding)


def require_calls(model: Any) -> None:
    """Refuse what is no dynamics model.

    Raises:
        ModelError: naming the calls that are missing.
    """
    missing = [name for name in CALLS if not callable(getattr(model, name, None))]
    missing += [name for name in ("joints", "n_dof") if not hasattr(model, name)]
    if missing:
        raise ModelError(
            f"{type(model).__name__} lacks {', '.join(missing)}",
            next_step="wrap a plain function tau(q, v, a) in lagnet.plausibility.torque_function.TorqueFunction",
        )
