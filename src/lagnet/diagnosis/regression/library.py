"""F X_k(q, v, a, τ_nominal): the columns of each hypothesis that these recordings can show, low-passed."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.effects.catalogue import CATALOGUE
from lagnet.effects.effect import Effect
from lagnet.effects.inertia.gravity_tilt import GravityTilt
from lagnet.effects.inertia.link_inertia import in_form
from lagnet.effects.motion import Motion
from lagnet.effects.transmission import Transmission
from lagnet.models.corrected.named_effects import NamedEffect, load_before
from lagnet.models.corrected.shifted_bodies import transmission_columns
from lagnet.models.corrected.shifted_weights import OFFSET, secant_columns
from lagnet.models.corrected.tilted_bodies import BODIES, body_in_turned_field, tilt_columns

MOST_KEPT = 400e6  # bytes of columns that are kept for the next search


@dataclass(frozen=True)
class Hypothesis:
    """One effect at one joint (None: the whole arm) with the values of its nonlinear parameters.

    `modelled` is how much of a law with one weight the nominal model holds: the weight may be as much below zero.
    """

    effect: str
    joint: int | None
    shape: tuple[tuple[str, float], ...] = ()
    modelled: float = 0.0

    @property
    def law(self) -> Effect:
        """The effect's class in the catalogue."""
        return CATALOGUE[self.effect]

    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Least and largest coefficients of its columns."""
        lower, upper = self.law.bounds(dict(self.shape))
        return lower - self.modelled * (np.arange(lower.size) == 0), upper

    @property
    def is_plain(self) -> bool:
        """Whether it is the plainest form of its law."""
        return self.law.special_case(dict(self.shape)) is None

    @property
    def place(self) -> tuple[str, int | None]:
        """Effect and joint, whatever the shape."""
        return self.effect, self.joint


@dataclass(frozen=True)
class Abstention:
    """An effect that these recordings do not excite, and why."""

    effect: str
    joint: int | None
    reason: str


@dataclass(frozen=True, eq=False)
class Library:
    """The hypotheses, their abstentions, and where their columns stand.

    Columns of joint j: those of its own hypotheses, then those that reach all joints, then the residual itself.

    Args:
        hypotheses: all of them; the index in this tuple names a hypothesis in a selection.
        widths: number of columns of each.
        n_dof: number of joints.
        abstentions: what was left out.
    """

    hypotheses: tuple[Hypothesis, ...]
    widths: tuple[int, ...]
    n_dof: int
    abstentions: tuple[Abstention, ...]

    def of(self, indices: Sequence[int]) -> Library:
        """Some of the hypotheses alone, in their order."""
        picked = tuple(indices)
        return Library(tuple(self.hypotheses[i] for i in picked), tuple(self.widths[i] for i in picked), self.n_dof, ())

    def with_more(self, hypotheses: Sequence[Hypothesis], widths: Sequence[int]) -> Library:
        """The library with further hypotheses behind its own, each of so many columns."""
        return replace(self, hypotheses=(*self.hypotheses, *hypotheses), widths=(*self.widths, *widths))

    @cached_property
    def reaching(self) -> tuple[int, ...]:
        """Indices of the arm-wide hypotheses: those that change the torque of other joints, too."""
        return tuple(i for i, h in enumerate(self.hypotheses) if h.law.reaches_all)

    @cached_property
    def local(self) -> tuple[tuple[int, ...], ...]:
        """For each joint the indices of the hypotheses that change its torque alone."""
        own: list[list[int]] = [[] for _ in range(self.n_dof)]
        for i, h in enumerate(self.hypotheses):
            if h.joint is not None and not h.law.reaches_all:
                own[h.joint].append(i)
        return tuple(map(tuple, own))

    @cached_property
    def slots(self) -> tuple[dict[int, np.ndarray], ...]:
        """For each joint, the column numbers of each hypothesis that acts on it."""
        return tuple(self._slots(j) for j in range(self.n_dof))

    def columns_of(self, joint: int, selection: Iterable[int]) -> np.ndarray:
        """Column numbers at a joint of those selected hypotheses that act on it, shape (k,)."""
        slots = self.slots[joint]
        picked = [slots[i] for i in selection if i in slots]
        return np.concatenate(picked) if picked else np.zeros(0, dtype=int)

    def _slots(self, joint: int) -> dict[int, np.ndarray]:
        found, at = {}, 0
        for i in (*self.local[joint], *self.reaching):
            found[i] = np.arange(at, at + self.widths[i])
            at += self.widths[i]
        return found

    @cached_property
    def freedom(self) -> tuple[tuple[int, int], ...]:
        """Numbers of coefficients and of free numbers in the shape of each hypothesis."""
        shapes = (h.law.free_numbers(dict(h.shape)) for h in self.hypotheses)
        return tuple(zip(self.widths, shapes, strict=True))

    def incompatible_at(self, joint: int) -> set[tuple[int, int]]:
        """Pairs of a joint's hypotheses that may not stand together: the same law twice, or beside its special case."""
        return self._incompatible[joint]

    def may_stand_beside(self, index: int, others: Iterable[int]) -> bool:
        """Whether a hypothesis of one joint may stand together with others of that joint."""
        barred = self.incompatible_at(int(self.hypotheses[index].joint or 0))
        return not any((i, index) in barred for i in others)

    def terms_of(self, index: int) -> dict[str, int]:
        """The effects that a hypothesis of one joint is the sum of, with their numbers; none where one is missing."""
        own, terms = self.local[int(self.hypotheses[index].joint or 0)], self.hypotheses[index].law.sum_of
        found = {self.hypotheses[k].effect: k for k in own if self.hypotheses[k].effect in terms}
        return found if len(found) == len(terms) else {}

    @cached_property
    def _incompatible(self) -> tuple[set[tuple[int, int]], ...]:
        laws = {h.effect: {h.effect, *h.law.contains} for h in self.hypotheses}
        return tuple(
            {(i, k) for i in own for k in own if laws[self.hypotheses[i].effect] & laws[self.hypotheses[k].effect]}
            for own in self.local
        )

    @cached_property
    def by_width(self) -> tuple[list[tuple[np.ndarray, np.ndarray]], ...]:
        """For each joint its hypotheses of one width: their places among the local ones, and columns (m, w)."""
        return tuple(
            [self._of_width(j, w) for w in sorted({self.widths[i] for i in own})] for j, own in enumerate(self.local)
        )

    def _of_width(self, joint: int, width: int) -> tuple[np.ndarray, np.ndarray]:
        own = self.local[joint]
        places = np.array([n for n, i in enumerate(own) if self.widths[i] == width])
        starts = np.array([self.slots[joint][own[n]][0] for n in places])
        return places, starts[:, None] + np.arange(width)

    @cached_property
    def barred(self) -> tuple[np.ndarray, ...]:
        """For each joint, which of its hypotheses may not stand together, shape (m, m)."""
        return tuple(
            np.array([[(i, k) in pairs for k in own] for i in own], dtype=bool).reshape(len(own), len(own))
            for own, pairs in zip(self.local, self._incompatible, strict=True)
        )

    def bounds_at(self, joint: int) -> tuple[np.ndarray, np.ndarray]:
        """Least and largest coefficients of a joint's columns, each of shape (width,)."""
        return self._bounds[joint]

    @cached_property
    def _bounds(self) -> tuple[tuple[np.ndarray, np.ndarray], ...]:
        out = []
        for joint in range(self.n_dof):
            own = (self.hypotheses[i] for i in self.slots[joint])
            pairs = [h.bounds() for h in own]
            lower, upper = zip(*pairs, strict=True) if pairs else ((np.zeros(0),), (np.zeros(0),))
            out.append((np.concatenate(lower), np.concatenate(upper)))
        return tuple(out)

    def width(self, joint: int) -> int:
        """Number of columns of a joint, the residual not counted."""
        return sum(self.widths[i] for i in (*self.local[joint], *self.reaching))

    def tables(self, problem: Problem, piece: Segment, joints: Sequence[int] | None = None) -> Iterator[np.ndarray]:
        """[F X, r] of each of these joints (None: all) on one segment, shape (len(keep), width + 1)."""
        joints = range(self.n_dof) if joints is None else joints
        residual = problem.residual(piece)
        columns = self._reduced(problem, piece, joints)
        for joint in joints:
            near = [columns[i] for i in self.local[joint]]
            far = [columns[i][:, joint] for i in self.reaching]
            yield np.column_stack([*near, *far, residual[:, joint]])

    def _reduced(self, problem: Problem, piece: Segment, joints: Sequence[int]) -> dict[int, np.ndarray]:
        """F X_k of each hypothesis, shape (len(keep), k) or (len(keep), dof, k); the piece keeps them if they fit."""
        keys = [self._follows_from(problem, i) for i in range(len(self.hypotheses))]
        out = {i: piece.columns[key] for i, key in enumerate(keys) if key in piece.columns}
        motion = piece.motion(problem)
        groups = (*(self.local[j] for j in joints), *((i,) for i in self.reaching))
        for group in groups:  # filtered together, and not all in memory at once
            fresh = [i for i in group if i not in out]
            if fresh:
                out.update(zip(fresh, self._filtered(problem, piece, motion, fresh), strict=True))
        if self._size * sum(p.keep.size for p in (*problem.fit, *problem.holdout)) <= MOST_KEPT:
            piece.columns.update((keys[i], x) for i, x in out.items())
        return out

    def _filtered(
        self, problem: Problem, piece: Segment, motion: Motion, indices: Sequence[int]
    ) -> Iterator[np.ndarray]:
        columns = [self._columns(i, motion, problem) for i in indices]
        flat = problem.reduce(piece, np.hstack([x.reshape(len(x), -1) for x in columns]))
        at = 0
        for x in columns:
            width = int(np.prod(x.shape[1:]))
            yield np.ascontiguousarray(flat[:, at : at + width]).reshape(len(flat), *x.shape[1:])
            at += width

    @cached_property
    def _size(self) -> int:
        """Bytes of all columns of one sample."""
        return 8 * sum(
            w * (self.n_dof if h.law.reaches_all else 1) for w, h in zip(self.widths, self.hypotheses, strict=True)
        )

    def _follows_from(self, problem: Problem, index: int) -> Hashable:
        """What the columns of a hypothesis follow from, on a given piece."""
        h = self.hypotheses[index]
        if h.law.of_motion_alone and h.joint is not None:
            return h, _sign_model(problem, h.joint)
        sign = tuple(None if x is None else x.tobytes() for x in (problem.slow, problem.straight, problem.held))
        known = problem.known_to(h.law) if h.law.uses_load or h.effect in (*BODIES, OFFSET, GravityTilt.name) else ()
        return h, sign, tuple((e.effect, e.joint, tuple(e.values.items())) for e in known)

    def _columns(self, index: int, motion: Motion, problem: Problem) -> np.ndarray:
        h = self.hypotheses[index]
        known = problem.known_to(h.law)
        seen = as_seen(motion, known, h.law)
        if known and isinstance(h.law, Transmission) and h.joint is not None:
            return transmission_columns(seen, h.law, h.joint, known, dict(h.shape))
        columns = h.law.columns(seen, h.joint, dict(h.shape))
        if known and isinstance(h.law, GravityTilt):
            return tilt_columns(motion, h.law, dict(h.shape), known, columns)
        if known and h.effect == OFFSET and h.joint is not None:
            return secant_columns(motion, h.joint, known, columns)
        if known and h.effect in BODIES:
            link = motion.n_dof - 1 if h.joint is None else h.joint
            field = body_in_turned_field(motion, link, known)
            return columns + (in_form(field, dict(h.shape)) if isinstance(field, np.ndarray) else field)
        return columns


def as_seen(motion: Motion, known: tuple[NamedEffect, ...], law: Effect) -> Motion:
    """The motion with the torque τ_nominal + Σ τ_body that a law acts on."""
    if not known or law.stage == "body":
        return motion
    key = ("load before", law.stage, *(e.key for e in known), motion.slow.tobytes())
    return motion.with_load(motion.remembered(key, lambda: load_before(motion, known, law.stage)))


def of_motion_alone(columns: Mapping[Hashable, np.ndarray]) -> dict[Hashable, np.ndarray]:
    """Of the columns that a segment keeps those that hold against any nominal model: they follow from q, v, a."""
    return {key: x for key, x in columns.items() if isinstance(key, tuple) and key[0].law.of_motion_alone}


def _sign_model(problem: Problem, joint: int) -> tuple[float, bool, float]:
    """What the direction of a joint follows from: slow speed, blur, and the speed at which it is held."""
    straight = problem.straight is not None and bool(problem.straight[joint])
    held = 0.0 if problem.held is None else max(float(problem.held[joint]), 0.0)
    return float(problem.slow[joint]), straight, held
