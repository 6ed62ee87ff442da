"""The parameters of a fixed set, fitted jointly to one recording: what can be compared from day to day.

A body that was found once, such as a tool, is followed by one number, its share λ: the torque Y(q, v, a) λ p̂ of its
ten inertial parameters p̂ as first found. One recording seldom determines all ten, so that mass or centre alone would
jump from day to day while the torque stays the same; λ is 0 where the body is absent and 1 where it is as found.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.stats import t as student

from lagnet.diagnosis.estimation.delta_method import parameter_jacobian
from lagnet.diagnosis.estimation.gauss_newton import GaussNewton, spread
from lagnet.diagnosis.estimation.slots import Slots
from lagnet.diagnosis.problem.problem import Problem, pose_problem
from lagnet.effects.catalogue import effect_named
from lagnet.effects.inertia.link_inertia import LinkInertia
from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.corrected.named_effects import NamedEffect, load_before, torque_with
from lagnet.recordings.conditioning.condition import condition
from lagnet.recordings.recording import Recording
from lagnet.tracking.tracked_set import TrackedSet
from lagnet.types import joint_types_of

ROUNDS = 2  # of the weights: residuals of the second fit are those of the fitted model
SHARE = "share"  # the one parameter of a body that is followed


@dataclass(frozen=True)
class ParameterRow:
    """A followed parameter in one recording, with its 95 % interval; `joint` is None for the whole arm."""

    effect: str
    joint: str | None
    parameter: str
    unit: str
    value: float
    lower: float
    upper: float


@dataclass(frozen=True, eq=False)
class FixedFit:
    """A set fitted to one recording.

    Args:
        effects: with the fitted values, as the model with them takes them.
        rows: the parameters that are followed.
        load: shape (dof,), mean magnitude of the torque that the bodies need, as the transmission feels it [N m].
        left: shape (dof,), residual, root mean square [N m].
    """

    effects: tuple[NamedEffect, ...]
    rows: tuple[ParameterRow, ...]
    load: np.ndarray
    left: np.ndarray


@dataclass(frozen=True, eq=False)
class FollowedSlots(Slots):
    """Where the coordinates stand: those of the effects, then the shares of the bodies.

    Args:
        bodies: link and the ten inertial parameters p̂ of each.
    """

    bodies: tuple[tuple[int, np.ndarray], ...] = ()

    def named(self, x: np.ndarray) -> tuple[NamedEffect, ...]:
        """The effects at coordinates x; a body with a negative share takes mass away, as a change of the link does."""
        law = LinkInertia()
        shares = x[self.starts[-1] :]
        carried = [
            NamedEffect(law.name, k, law.from_coordinates(s * p)) for s, (k, p) in zip(shares, self.bodies, strict=True)
        ]
        return (*Slots.named(self, x), *carried)

    def changed(self, x: np.ndarray, i: int, value: float) -> tuple[int, NamedEffect]:
        """Number of the effect that coordinate i changes, and that effect with another value of it."""
        share = i - int(self.starts[-1])
        if share < 0:
            return Slots.changed(self, x, i, value)
        n = len(self.effects) + share
        return n, self.named(np.where(np.arange(x.size) == i, value, x))[n]

    def of_bodies(self) -> np.ndarray:
        """No coordinate is one of the ten of a body, shape (k,)."""
        return np.zeros(self.starts[-1] + len(self.bodies), dtype=bool)

    def chosen(self) -> np.ndarray:
        """Whether a coordinate stands at the value of a special case, shape (k,); no share does."""
        return np.append(Slots.chosen(self), np.zeros(len(self.bodies), dtype=bool))

    @cached_property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper bounds; shares have none."""
        lower, upper = super().bounds if self.effects else (np.zeros(0), np.zeros(0))
        free = np.full(len(self.bodies), np.inf)
        return np.append(lower, -free), np.append(upper, free)


def fit_set(recording: Recording, nominal: Any, tracked: TrackedSet) -> FixedFit:
    """Gauss–Newton on the parameters of all effects of the set together, at the set's bandwidth and s(v).

    Args:
        recording: all of it is fitted.
        nominal: the nominal model of the make.
        tracked: the set, with values from which to start.

    Raises:
        DiagnosisError: the recording is too short to be filtered.
    """
    fit = condition([recording], tracked.bandwidth)
    model = model_with(nominal, tracked.held, tracked) if tracked.held else nominal
    problem = replace(
        pose_problem(model, fit, fit, (None,)),
        slow=np.array(tracked.slow),
        straight=None if tracked.straight is None else np.array(tracked.straight),
        held=None if tracked.rest is None else np.array(tracked.rest),
    )
    slots, x = _slots(tracked.effects, problem.n_dof)
    for _ in range(ROUNDS):
        sigma = np.maximum(_left(problem, slots.named(x)), 1e-6 * problem.scale + 1e-12)
        work = GaussNewton(problem, spread(problem.fit), sigma, slots, slots.chosen())
        x = work.descend(np.clip(x, *slots.bounds), np.ones(x.size, dtype=bool))
    effects = slots.named(x)
    rows = _rows(work, x, tracked, problem) if x.size else ()
    return FixedFit(effects, rows, _load(problem, effects), _left(problem, effects))


def model_with(nominal: Any, effects: Sequence[NamedEffect], tracked: TrackedSet) -> CorrectedModel:
    """The nominal model with effects, under the set's s(v)."""
    straight = None if tracked.straight is None else np.array(tracked.straight)
    rest = None if tracked.rest is None else np.array(tracked.rest)
    return CorrectedModel(nominal, tuple(effects), np.array(tracked.slow), rest, straight)


def _slots(effects: Sequence[NamedEffect], n_dof: int) -> tuple[FollowedSlots, np.ndarray]:
    """The coordinates of a set, and where they start: shares at zero."""
    own = tuple(e for e in effects if not effect_named(e.effect).is_body)
    carried = [e for e in effects if effect_named(e.effect).is_body]
    parts = [e.coordinates() for e in own]
    starts = np.concatenate([[0], np.cumsum([p.size for p in parts], dtype=int)]).astype(int)
    bodies = tuple((n_dof - 1 if e.joint is None else e.joint, e.body_parameters) for e in carried)
    return FollowedSlots(own, starts, bodies), np.concatenate([*parts, np.zeros(len(bodies))])


def _left(problem: Problem, effects: Sequence[NamedEffect]) -> np.ndarray:
    """Residual after effects where joints move, root mean square, shape (dof,)."""
    power, count = np.zeros(problem.n_dof), np.zeros(problem.n_dof)
    for piece in problem.fit:
        rest = problem.reduce(piece, piece.tau - torque_with(piece.motion(problem), effects)) * piece.counts
        power, count = power + np.sum(rest**2, axis=0), count + piece.counts.sum(axis=0)
    return np.sqrt(power / np.maximum(count, 1.0))


def _load(problem: Problem, effects: Sequence[NamedEffect]) -> np.ndarray:
    bodies = [np.abs(load_before(p.motion(problem), effects, "torque")) for p in problem.fit]
    return np.concatenate(bodies).mean(axis=0)


def _rows(work: GaussNewton, x: np.ndarray, tracked: TrackedSet, problem: Problem) -> tuple[ParameterRow, ...]:
    covariance, freedom = work.covariance(x)
    width = float(student.ppf(0.975, freedom))
    kinds = joint_types_of(problem.nominal, problem.n_dof)
    slots = work.slots
    out = []
    for n, effect in enumerate(slots.effects):
        at = slots.of(n)
        slopes = parameter_jacobian(effect, x[at])
        spreads = width * np.sqrt(np.maximum(np.einsum("pk,kl,pl->p", slopes, covariance[at, at], slopes), 0.0))
        values = effect.at_coordinates(x[at]).values
        joint = None if effect.joint is None else problem.joints[effect.joint]
        sliding = effect.joint is not None and kinds[effect.joint] == "prismatic"
        law = effect_named(effect.effect)
        for p, half in zip(law.parameters, spreads, strict=True):
            if p.name in law.settled:  # a choice between forms has no course over time
                continue
            value, half = float(values[p.name]), float(half)
            out.append(
                ParameterRow(effect.effect, joint, p.name, p.unit_for(sliding), value, value - half, value + half)
            )
    carried = [e for e in tracked.effects if effect_named(e.effect).is_body]
    for effect, k in zip(carried, range(int(slots.starts[-1]), x.size), strict=True):
        joint, half = (
            None if effect.joint is None else problem.joints[effect.joint],
            width * float(np.sqrt(covariance[k, k])),
        )
        out.append(ParameterRow(effect.effect, joint, SHARE, "–", float(x[k]), float(x[k]) - half, float(x[k]) + half))
    return tuple(out)
