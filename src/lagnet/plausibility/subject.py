"""The model under examination, the motion that it is meant for, and the size and rounding of its numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from lagnet.decomposition.offers import offers
from lagnet.errors import ModelError
from lagnet.plausibility.calling import CarefulCalls
from lagnet.plausibility.ranges import Ranges, ranges_of
from lagnet.plausibility.settings import CheckSettings
from lagnet.recordings.recording import Recording
from lagnet.types import JointVector, MassMatrix, Trajectory

CALLS = ("inverse_dynamics", "mass_matrix", "coriolis_torque", "gravity_torque")
UNITS = {"q": ("rad", "m"), "v": ("rad/s", "m/s"), "tau": ("N m", "N")}  # of turning and of sliding joints
NEGLIGIBLE = 1e-9  # of the torque: less than this is no residual
COARSEST_ROUNDING = 1e-6  # single precision; a model that is noisier gets no slack for it


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

    def unit(self, signal: str, joint: int) -> str:
        """Unit of a signal (q, v or tau) of a joint."""
        turns, slides = UNITS[signal]
        return turns if self.ranges.revolute[joint] else slides

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

    @cached_property
    def residual_present(self) -> np.ndarray:
        """Which joints have a residual at all, shape (dof,): a model may offer one that is zero."""
        if not self.offers("residual_torque"):
            return np.zeros(self.n_dof, dtype=bool)
        size = np.sqrt(np.mean(self.residual(*self.random(256, salt=10)) ** 2, axis=0))
        return size > NEGLIGIBLE * self.torque_scale

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
        """One call of the model, see `CarefulCalls.call`."""
        return self._calls.call(name, *arrays)

    @cached_property
    def believed(self) -> CarefulCalls:
        """The reference, called as carefully as the model; only where there is one."""
        return CarefulCalls(self.reference)

    @cached_property
    def _calls(self) -> CarefulCalls:
        return CarefulCalls(self.model)

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
