"""Σ_k r_k(q, v, a, t; p_k): named effects with their parameters, and the torque of a model with them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.effects.catalogue import effect_named
from lagnet.effects.effect import STAGES, Stage
from lagnet.effects.motion import Motion
from lagnet.models.corrected.presence import presence
from lagnet.models.corrected.shifted_bodies import shifted_bodies
from lagnet.models.corrected.shifted_weights import shifted_weight
from lagnet.models.corrected.tilted_bodies import tilted_weight
from lagnet.rigid_body.inertia import BODY
from lagnet.types import Trajectory

EDGES = ("t0", "t1")  # start and end of an effect on an interval


@dataclass(frozen=True)
class NamedEffect:
    """r_k(q, v, a, t; p): one effect of the catalogue with its parameters, at a joint or on the whole arm.

    Args:
        effect: name in the catalogue.
        joint: index of the joint, None for the whole arm.
        values: parameters by name, SI units.
        interval: (start, end) [s] outside which the effect is absent; None: always there.
        recording: index of the fitted recording in which it was found; nowhere else does it act. None: in any.
        modelled: how much of its first parameter the nominal model holds: by so much it may be below zero.
    """

    effect: str
    joint: int | None
    values: Mapping[str, float]
    interval: tuple[float, float] | None = None
    recording: int | None = None
    modelled: float = 0.0

    @property
    def always_acts(self) -> bool:
        """Whether it is there at all times and in all recordings."""
        return self.interval is None and self.recording is None

    @property
    def key(self) -> tuple:
        """Effect, joint, parameters, interval and recording as a value to be looked up by."""
        return self.effect, self.joint, tuple(self.values.items()), self.interval, self.recording

    @property
    def is_free_body(self) -> bool:
        """Whether ten inertial parameters, each by itself, are the first of its coordinates."""
        law = effect_named(self.effect)
        return law.is_body and law.coordinates(self.values).size == BODY

    @property
    def body_parameters(self) -> np.ndarray:
        """What it adds to the ten inertial parameters of its link, shape (10,)."""
        return effect_named(self.effect).body_parameters(self.values)

    def coordinates(self) -> np.ndarray:
        """x(p), shape (k,): the coordinates of the law, which a refit changes, then t0 and t1 where there are any."""
        return np.append(effect_named(self.effect).coordinates(self.values), self.interval or ())

    def at_coordinates(self, x: np.ndarray) -> NamedEffect:
        """The effect with other coordinates."""
        interval = None if self.interval is None else (float(x[-2]), float(x[-1]))
        own = x if interval is None else x[:-2]
        return replace(self, values=effect_named(self.effect).moved(self.values, own), interval=interval)

    def coordinate_bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper bounds of the coordinates."""
        lower, upper = effect_named(self.effect).coordinate_bounds(self.values)
        lower = lower - self.modelled * (np.arange(lower.size) == 0)
        n_edges = len(self.interval or ())
        return np.append(lower, np.full(n_edges, -np.inf)), np.append(upper, np.full(n_edges, np.inf))

    def chosen(self) -> np.ndarray:
        """Which coordinates stand at the value of a special case, shape (k,)."""
        own = effect_named(self.effect).chosen(self.values)
        return np.append(own, np.zeros(len(self.interval or ()), dtype=bool))

    def parameters(self) -> dict[str, float]:
        """Values by name, with t0 and t1 [s] where the effect acts on an interval."""
        edges = {} if self.interval is None else dict(zip(EDGES, map(float, self.interval), strict=True))
        return {**self.values, **edges}

    def added(self, motion: Motion) -> np.ndarray:
        """r_k along a motion, shape (n, dof) [N m]."""
        full = np.zeros_like(motion.load)
        for joint, torque in self.added_at(motion).items():
            full[:, joint] = torque
        return full

    def added_at(self, motion: Motion) -> dict[int, np.ndarray]:
        """r_k along a motion by joint, each of shape (n,) [N m]; joints that are not in it have none."""
        share = presence(motion, self)
        if not np.any(share):
            return {}
        torque = effect_named(self.effect).torque(motion, self.joint, self.values)
        if torque.ndim == 1 and self.joint is not None:
            found = {self.joint: torque}
        else:
            found = {j: torque[:, j] for j in range(motion.n_dof) if torque[:, j].any()}
        return found if self.interval is None else {j: x * share for j, x in found.items()}


def torque_with(motion: Motion, effects: Sequence[NamedEffect]) -> Trajectory:
    """τ_nominal + Σ_k r_k, the nominal torque `motion.load` with effects, stage by stage, shape (n, dof) [N m].

    Effects of one stage all act on the torque of the stages before; signals act one after the other.
    """
    tau = motion.load
    for stage in STAGES:
        before = motion.with_load(tau)
        for effect in (e for e in effects if effect_named(e.effect).stage == stage):
            tau = tau + effect.added(motion.with_load(tau) if stage == "signal" else before)
        if stage == "body":
            tau = tau + tilted_weight(motion, effects) + shifted_weight(motion, effects)
        if stage == "transmission":
            tau = tau + shifted_bodies(before, effects)
    return tau


def load_before(motion: Motion, effects: Sequence[NamedEffect], stage: Stage) -> Trajectory:
    """Torque that effects of a stage act on: τ_nominal with effects of earlier stages, shape (n, dof) [N m]."""
    earlier = STAGES[: STAGES.index(stage)]
    return torque_with(motion, [e for e in effects if effect_named(e.effect).stage in earlier])
