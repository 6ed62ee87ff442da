"""Consistent bodies where a refit ends with others, near the model where recordings do not determine them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.estimation.gauss_newton import GaussNewton
from lagnet.diagnosis.estimation.nearest_body import body_before, nearest_body
from lagnet.diagnosis.regression.normal_equations import bounded_step, inverse, leaves_open, normal
from lagnet.effects.catalogue import effect_named
from lagnet.rigid_body.inertia import BODY, is_physically_consistent


@dataclass(frozen=True, eq=False)
class _Tangent:
    """Half the squared error as a quadratic about a point: ½ (x − x₀)ᵀ G (x − x₀) + mᵀ(x − x₀)."""

    work: GaussNewton
    point: np.ndarray
    gram: np.ndarray
    moment: np.ndarray

    def settled(self, x: np.ndarray, free: np.ndarray) -> np.ndarray:
        """The least squares of the free coordinates within their bounds, the others as they are in x."""
        if not free.any():
            return x
        lower, upper = (b[free] for b in self.work.slots.bounds)
        slope = (self.moment + self.gram @ (x - self.point))[free]
        out = x.copy()
        step = bounded_step(self.gram[np.ix_(free, free)], -slope, lower - x[free], upper - x[free])
        out[free] = np.clip(x[free] + step, lower, upper)
        return out

    def told(self, own: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Information on a body: (10, 10) with all else refitted around it, diagonal (10,) with all else known."""
        others = np.setdiff1d(np.arange(len(self.gram)), own)
        cross = self.gram[np.ix_(own, others)]
        around = cross @ inverse(self.gram[np.ix_(others, others)]) @ cross.T if others.size else 0.0
        schur = self.gram[np.ix_(own, own)] - around
        return 0.5 * (schur + schur.T), np.diag(self.gram)[own]


def _tangent(work: GaussNewton, x: np.ndarray) -> _Tangent:
    residual, jacobian = work.linear(x)
    return _Tangent(work, x, *normal(jacobian, residual))


def with_physical_bodies(work: GaussNewton, x: np.ndarray) -> np.ndarray:
    """Replaces bodies that are not consistent or not determined by the nearest consistent ones, and refits all else.

    Where several are named they are made real together: bodies next to each other share masses, and one after the other
    would hold what the next one needs. Making one real moves all else, so it is given a second chance; from then on it
    is held. The others follow along the tangent, and by the exact laws at the end.
    """
    bodies = _bodies(work)
    if len(bodies) > 1 and not all(_is_consistent(work, x, n) for n in bodies):
        return _all_real(work, x, bodies)
    if not bodies:
        return x
    tried, held = set[int](), np.zeros(x.size, dtype=bool)
    while True:
        tangent, fixed = _tangent(work, x), held.copy()
        moved = False
        while (n := _body_to_move(tangent, x, tried)) is not None:
            own = _own(work, x, n)
            x = x.copy()
            x[own] = _near(tangent, x, n)
            held[own] = n in tried
            tried.add(n)
            fixed[own] = moved = True
            x = tangent.settled(x, ~(held | np.isin(np.arange(x.size), own)))
        if not moved:
            return x
        x = work.descend(x, ~(held | fixed))


def _all_real(work: GaussNewton, x: np.ndarray, bodies: list[int]) -> np.ndarray:
    """The nearest consistent bodies, all of them together."""
    own = np.concatenate([_own(work, x, n) for n in bodies])
    base = np.array([body_before(work.problem, work.slots.effects[n]) for n in bodies])
    x, information = x.copy(), _tangent(work, x).told(own)[0]
    x[own] = (nearest_body(information, base + x[own].reshape(base.shape), base) - base).ravel()
    return work.descend(x, ~np.isin(np.arange(x.size), own))


def _bodies(work: GaussNewton) -> list[int]:
    return [n for n, e in enumerate(work.slots.effects) if e.is_free_body]


def _is_consistent(work: GaussNewton, x: np.ndarray, n: int) -> bool:
    base = body_before(work.problem, work.slots.effects[n])
    return bool(is_physically_consistent(base + x[_own(work, x, n)]))


def _body_to_move(tangent: _Tangent, x: np.ndarray, tried: set[int]) -> int | None:
    """The first effect whose body is not physically consistent, or whose link the recordings do not determine."""
    work = tangent.work
    for n in _bodies(work):
        if not _is_consistent(work, x, n):
            return n
        link = effect_named(work.slots.effects[n].effect).changes_link
        if link and n not in tried and leaves_open(*tangent.told(_own(work, x, n))):
            return n
    return None


def _own(work: GaussNewton, x: np.ndarray, n: int) -> np.ndarray:
    return np.arange(x.size)[work.slots.of(n)][:BODY]  # the edges of a load that is carried for a while follow


def _near(tangent: _Tangent, x: np.ndarray, n: int) -> np.ndarray:
    """Coordinates of the nearest consistent body, all else being refitted around it."""
    own, base = _own(tangent.work, x, n), body_before(tangent.work.problem, tangent.work.slots.effects[n])
    return nearest_body(tangent.told(own)[0], base + x[own], base) - base
