"""Bodies that masses can have, where a refit ends with others, and near the model where recordings leave them open."""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.nearest_body import body_before, nearest_body
from lagnet.diagnosis.normal_equations import inverse, leaves_open, normal
from lagnet.diagnosis.refit_work import BODIES, Work
from lagnet.rigid_body.inertia import is_physically_consistent

BODY = 10  # coordinates of a body; where it is carried for a while, the edges follow


def made_real(work: Work, x: np.ndarray) -> np.ndarray:
    """Replaces bodies that no mass can have, or that recordings leave open, by near real ones, and refits the rest.

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


def _body_to_move(work: Work, x: np.ndarray, tried: set[int]) -> int | None:
    """The first effect whose body no mass can have, or whose link the recordings leave open."""
    for n, effect in enumerate(work.slots.effects):
        if effect.effect not in BODIES:
            continue
        if not is_physically_consistent(body_before(work.problem, effect) + x[_own(work, x, n)]):
            return n
        if effect.effect == "link_inertia" and n not in tried and _is_open(work, x, n):
            return n
    return None


def _own(work: Work, x: np.ndarray, n: int) -> np.ndarray:
    return np.arange(x.size)[work.slots.of(n)][:BODY]


def _is_open(work: Work, x: np.ndarray, n: int) -> bool:
    return leaves_open(*_told(work, x, n))


def _near(work: Work, x: np.ndarray, n: int) -> np.ndarray:
    """Coordinates of a near real body, all else being refitted around it."""
    base = body_before(work.problem, work.slots.effects[n])
    return nearest_body(_told(work, x, n)[0], base + x[_own(work, x, n)], base) - base


def _told(work: Work, x: np.ndarray, n: int) -> tuple[np.ndarray, np.ndarray]:
    """What the recordings say of a body: (10, 10) with all else refitted around it, (10,) with all else known."""
    own = _own(work, x, n)
    gram, _ = normal(work.jacobian(x, np.ones(x.size, dtype=bool)), work.residuals(x))
    rest = np.setdiff1d(np.arange(x.size), own)
    cross = gram[np.ix_(own, rest)]
    schur = gram[np.ix_(own, own)] - (cross @ inverse(gram[np.ix_(rest, rest)]) @ cross.T if rest.size else 0.0)
    return 0.5 * (schur + schur.T), np.diag(gram)[own]
