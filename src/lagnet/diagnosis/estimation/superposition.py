"""τ_nominal + Σ_k τ_k along one motion, and what changes of it when one effect changes; the others stay computed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lagnet.diagnosis.estimation.moved_link import MovedLink
from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.effects.catalogue import effect_named
from lagnet.effects.effect import STAGES, Stage
from lagnet.effects.motion import Motion
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.models.corrected.shifted_bodies import shifted_bodies
from lagnet.models.corrected.shifted_weights import OFFSET, shifted_weight
from lagnet.models.corrected.tilted_bodies import TILT, tilted_weight

Change = dict[int, np.ndarray]
"""Torque by joint, each of shape (n,) [N m]; joints that are not in it have none."""


@dataclass(frozen=True, eq=False)
class _Part:
    """One effect: the load that it sees, shape (n, dof), and the torque that it adds [N m]."""

    seen: np.ndarray
    added: Change


class Superposition:
    """Effects along one motion, each under the load that `torque_with` gives it."""

    def __init__(self, motion: Motion, effects: Sequence[NamedEffect]):
        """Computes all effects.

        Args:
            motion: n samples.
            effects: in the order in which signals act.
        """
        self._motion, self._effects = motion, tuple(effects)
        self._parts: dict[int, _Part] = {}
        load = motion.load
        for stage in STAGES:
            before = load
            for n in self._of(stage):
                seen = load if stage == "signal" else before
                added = self._effects[n].added_at(motion.with_load(seen))
                self._parts[n] = _Part(seen, added)
                load = _plus(load, added)
            if stage == "body":
                self._products = _products(motion, self._effects)
                self._carried = load = load + self._products
            if stage == "transmission":
                load = load + shifted_bodies(motion.with_load(before), self._effects)
                self._transmitted = load - self._carried
        self.total = load

    def change(self, n: int, other: NamedEffect) -> Change:
        """By how much the torque changes if effect n becomes another of the same law and joint, near to it.

        Exact, but of first order in how far the change moves the links behind transmissions.
        """
        own: Change = {}  # a transmission's is computed with its products
        if not self._is_of(n, "transmission"):
            own = _minus(other.added_at(self._motion.with_load(self._parts[n].seen)), self._parts[n].added)
        moved = self._transmission_change if self._is_far(n, other) else self._transmission_slope
        return self._all_of(n, own, self._products_change(n, other), lambda change: moved(n, other, change))

    def without(self, n: int) -> Change:
        """By how much the torque changes if effect n goes."""
        products = _products(self._motion, self._with(n, None)) - self._products if self._is_of(n, "body") else 0.0
        own = {} if self._is_of(n, "transmission") else _minus({}, self._parts[n].added)
        return self._all_of(n, own, products, lambda change: self._transmission_change(n, None, change))

    def _with(self, n: int, other: NamedEffect | None) -> tuple[NamedEffect, ...]:
        return (*self._effects[:n], *(() if other is None else (other,)), *self._effects[n + 1 :])

    def _is_far(self, n: int, other: NamedEffect) -> bool:
        """Whether a change asks for all transmissions anew: of the field of gravity, or of when an effect acts."""
        return other.effect == TILT or other.interval != self._effects[n].interval

    def _all_of(
        self,
        n: int,
        change: Change,
        products: np.ndarray | float,
        with_transmissions: Callable[[Change], Change],
    ) -> Change:
        """A change of effect n's own torque, with that of its products and of all effects that see it."""
        of_bodies, of_links = self._is_of(n, "body"), self._is_of(n, "transmission")
        if of_bodies:
            change = _minus(change, {} if np.ndim(products) == 0 else _by_joint(-np.asarray(products)))
        if of_links or (of_bodies and self._of("transmission")):
            change = with_transmissions(change)
        if of_bodies or of_links:
            for after in [self._answer(m, change) for m in self._of("torque")]:  # all see the links alone
                change = _minus(change, {j: -x for j, x in after.items()})
        for m in self._of("signal"):
            if m > n or not self._is_of(n, "signal"):
                change = _minus(change, {j: -x for j, x in self._answer(m, change).items()})
        return change

    def _products_change(self, n: int, other: NamedEffect) -> np.ndarray | float:
        """What changes of products of tilt, bodies and encoder offsets; they are linear in each body."""
        if not self._is_of(n, "body"):
            return 0.0
        if effect_named(other.effect).is_body:
            others = [e for e in self._effects if e.effect in (TILT, OFFSET)]
            return _products(self._motion, [other, *others]) - _products(self._motion, [self._effects[n], *others])
        return _products(self._motion, self._with(n, other)) - self._products

    def _transmission_change(self, n: int, other: NamedEffect | None, change: Change) -> Change:
        """A change of the bodies' torque, with what transmissions add under that load and with another effect n."""
        felt, effects = self._motion.with_load(_plus(self._carried, change)), self._with(n, other)
        giving = [e for e in effects if effect_named(e.effect).stage == "transmission"]
        now = sum((e.added(felt) for e in giving), np.zeros_like(felt.load)) + shifted_bodies(felt, effects)
        return _minus(change, _by_joint(self._transmitted - now))

    def _transmission_slope(self, n: int, other: NamedEffect, change: Change) -> Change:
        """The same to first order in the change, of an effect that becomes another."""
        if self._is_of(n, "transmission"):
            return _minus(change, _by_joint(-self._moved_links[n].if_other(other)))
        felt, added = self._motion.with_load(_plus(self._carried, change)), np.zeros_like(self._carried)
        for link in self._moved_links.values():
            added += link.if_loaded(felt) + link.if_changed(self._effects[n], other)
        return _minus(change, _by_joint(-added))

    @cached_property
    def _moved_links(self) -> dict[int, MovedLink]:
        """Each transmission's link, where the transmission puts it."""
        felt, number = self._motion.with_load(self._carried), self._of("transmission")
        return {n: MovedLink(felt, self._effects[n], self._effects) for n in number}

    def _is_of(self, n: int, stage: Stage) -> bool:
        return effect_named(self._effects[n].effect).stage == stage

    def _of(self, stage: Stage) -> list[int]:
        return [n for n in range(len(self._effects)) if self._is_of(n, stage)]

    def _answer(self, m: int, change: Change) -> Change:
        """By how much an effect changes if the load that it sees does."""
        effect, part = self._effects[m], self._parts[m]
        if not effect_named(effect.effect).uses_load or effect.joint not in change:
            return {}
        return _minus(effect.added_at(self._motion.with_load(_plus(part.seen, change))), part.added)


def reduced(problem: Problem, piece: Segment, change: Change) -> np.ndarray:
    """F Δτ of a change along a segment, shape (len(keep), dof) [N m]."""
    out = np.zeros((piece.keep.size, problem.n_dof))
    if change:
        out[:, list(change)] = problem.reduce(piece, np.column_stack(list(change.values())))
    return out


def _products(motion: Motion, effects: Sequence[NamedEffect]) -> np.ndarray | float:
    """Torque that effects on bodies have only together, shape (n, dof) [N m]; 0 where there is none."""
    return tilted_weight(motion, effects) + shifted_weight(motion, effects)


def _by_joint(torque: np.ndarray) -> Change:
    return {j: torque[:, j] for j in range(torque.shape[1]) if torque[:, j].any()}


def _plus(load: np.ndarray, change: Change) -> np.ndarray:
    out = load.copy()
    for joint, torque in change.items():
        out[:, joint] += torque
    return out


def _minus(one: Change, other: Change) -> Change:
    out = dict(one)
    for joint, torque in other.items():
        out[joint] = out[joint] - torque if joint in out else -torque
    return out
