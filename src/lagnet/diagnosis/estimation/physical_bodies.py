"""Consistent bodies where a refit ends with others, near the model where recordings do not determine them."""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.estimation.gauss_newton import GaussNewton
from lagnet.diagnosis.estimation.nearest_body import body_before, nearest_body
from lagnet.diagnosis.regression.normal_equations import inverse, leaves_open, normal
from lagnet.effects.catalogue import effect_named
from lagnet.rigid_body.inertia import is_physically_consistent

BODY = 10  # coordinates of a body; where it is carried for a while, the edges follow


def with_physical_bodies(work: GaussNewton, x: np.ndarray) -> np.ndarray:
    """Replaces bodies that are not consistent or not determined by the nearest consistent ones, and refits all else.

    Making one body real moves the others, so each is given a second chance; from then on it is held.
    """
    tried, held = set[int](), np.zeros(x.size, dtype=bool)
    while (n := _body_to_move(work, x, tried)) is not None:
        own = _own(work, x, n)
        x = x.copy()
        x[own] = _near(work, x, n)
        held[own] = n in tried
        tried.add(n)
        x = work.descend(x, ~(held | np.isin(np.arange(x.size), own)))
    return x


def _body_to_move(work: GaussNewton, x: np.ndarray, tried: set[int]) -> int | None:
    """The first effect whose body is not physically consistent, or whose link the recordings do not determine."""
    for n, effect in enumerate(work.slots.effects):
        if not effect_named(effect.effect).is_body:
            continue
        if not is_physically_consistent(body_before(work.problem, effect) + x[_own(work, x, n)]):
            return n
        if effect_named(effect.effect).changes_link and n not in tried and _is_open(work, x, n):
            return n
    return None


def _own(work: GaussNewton, x: np.ndarray, n: int) -> np.ndarray:
    return np.arange(x.size)[work.slots.of(n)][:BODY]


def _is_open(work: GaussNewton, x: np.ndarray, n: int) -> bool:
    return leaves_open(*_told(work, x, n))


def _near(work: GaussNewton, x: np.ndarray, n: int) -> np.ndarray:
    """Coordinates of the nearest consistent body, all else being refitted around it."""
    base = body_before(work.problem, work.slots.effects[n])
    return nearest_body(_told(work, x, n)[0], base + x[_own(work, x, n)], base) - base


def _told(work: GaussNewton, x: np.ndarray, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Information on a body: (10, 10) with all else refitted around it, diagonal (10,) with all else known."""
    own = _own(work, x, n)
    gram, _ = normal(work.jacobian(x, np.ones(x.size, dtype=bool)), work.residuals(x))
    rest = np.setdiff1d(np.arange(x.size), own)
    cross = gram[np.ix_(own, rest)]
    schur = gram[np.ix_(own, own)] - (cross @ inverse(gram[np.ix_(rest, rest)]) @ cross.T if rest.size else 0.0)
    return 0.5 * (schur + schur.T), np.diag(gram)[own]
