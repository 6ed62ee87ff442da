"""All parameters of the named effects together, by the exact laws, inside physical bounds, with their intervals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag
from scipy.stats import t as student

from lagnet.diagnosis.grams import BLOCK
from lagnet.diagnosis.nearest_body import body_before, nearest_body
from lagnet.diagnosis.normal_equations import bounded_step, inverse, normal, power_of_all
from lagnet.diagnosis.problem import Piece, Problem, spread_evenly
from lagnet.diagnosis.slopes import correlations_of, slopes_of
from lagnet.models.corrected import NamedEffect, torque_with
from lagnet.rigid_body.inertia import is_physically_consistent

STEPS = 12  # Gauss–Newton steps at most; a handful suffice from the search's start
DONE = 1e-6  # relative change of the error at which the steps end
MOST_SAMPLES = 60_000  # of the full rate: longer recordings are refitted on pieces spread over them
BODY = 10  # coordinates of a body; where it is carried for a while, the edges follow
DIFFERENCE = 1e-4  # relative step of the derivatives by finite differences


@dataclass(frozen=True, eq=False)
class Refit:
    """Effects with jointly fitted parameters.

    Args:
        effects: in the order given.
        intervals: for each effect, for each parameter, the 95 % interval.
        correlations: shape (n_parameters, n_parameters) of the coordinates of all effects.
    """

    effects: tuple[NamedEffect, ...]
    intervals: tuple[dict[str, tuple[float, float]], ...]
    correlations: np.ndarray


@dataclass(frozen=True, eq=False)
class _Slots:
    """Where each effect's coordinates stand in the vector of all."""

    effects: tuple[NamedEffect, ...]
    starts: np.ndarray

    def of(self, n: int) -> slice:
        return slice(int(self.starts[n]), int(self.starts[n + 1]))

    def named(self, x: np.ndarray) -> tuple[NamedEffect, ...]:
        return tuple(e.at_coordinates(x[self.of(n)]) for n, e in enumerate(self.effects))

    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        pairs = [e.coordinate_bounds() for e in self.effects]
        return np.concatenate([p[0] for p in pairs]), np.concatenate([p[1] for p in pairs])


@dataclass(frozen=True, eq=False)
class Tangent:
    """A fit made linear at its end.

    Args:
        pieces: what was fitted.
        residuals, jacobians: of each piece, shapes (len(keep), dof) and (len(keep), dof, n_coordinates), over σ.
        slopes: shape (n_parameters, n_coordinates), of the parameters of all effects in order.
    """

    pieces: tuple[Piece, ...]
    residuals: list[np.ndarray]
    jacobians: list[np.ndarray]
    slopes: np.ndarray


def tangent_at(problem: Problem, effects: Sequence[NamedEffect], sigma: np.ndarray) -> Tangent:
    """Residuals of fitted effects, and how they and the parameters change with the coordinates; see `refit`."""
    work, x = _start(problem, effects, sigma)
    jacobians = work.jacobian(x, np.ones(x.size, dtype=bool))
    blocks = [slopes_of(e, x[work.slots.of(n)]) for n, e in enumerate(effects)]
    return Tangent(work.pieces, work.residuals(x), jacobians, np.asarray(block_diag(*blocks)))


def blocks_of(problem: Problem, pieces: Sequence[Piece]) -> list[list[np.ndarray]]:
    """Rows of each block of time of each piece, long against the memory of the residual."""
    rate = problem.rate / max(1, int(np.median(np.diff(pieces[0].keep))))
    length = max(8, int(BLOCK * rate / problem.bandwidth))
    counts = [max(1, round(p.keep.size / length)) for p in pieces]
    return [np.array_split(np.arange(p.keep.size), n) for p, n in zip(pieces, counts, strict=True)]


def _start(problem: Problem, effects: Sequence[NamedEffect], sigma: np.ndarray) -> tuple[_Work, np.ndarray]:
    parts = [e.coordinates() for e in effects]
    slots = _Slots(tuple(effects), np.concatenate([[0], np.cumsum([p.size for p in parts])]))
    return _Work(problem, spread(problem.fit), sigma, slots), np.concatenate(parts)


def refit(problem: Problem, effects: Sequence[NamedEffect], sigma: np.ndarray) -> Refit:
    """Gauss–Newton from the search's values, joints weighted by 1/σ².

    Args:
        problem: the fit pieces are used, a spread of them where there are very many samples.
        effects: with starting values.
        sigma: shape (dof,), residual of each joint [N m].
    """
    if not effects:
        return Refit((), (), np.zeros((0, 0)))
    work, start = _start(problem, effects, sigma)
    slots = work.slots
    x = work.descend(np.clip(start, *slots.bounds()), np.ones(start.size, dtype=bool))
    x = _made_consistent(work, x)
    covariance, freedom = work.covariance(x)
    return Refit(slots.named(x), _intervals(slots, x, covariance, freedom), correlations_of(covariance))


def spread(pieces: Sequence[Piece], most: int = MOST_SAMPLES) -> tuple[Piece, ...]:
    """The pieces that a refit uses."""
    return spread_evenly(pieces, most)


@dataclass(frozen=True, eq=False)
class _Work:
    problem: Problem
    pieces: tuple[Piece, ...]
    sigma: np.ndarray
    slots: _Slots

    def __post_init__(self) -> None:
        object.__setattr__(self, "motions", tuple(p.motion(self.problem) for p in self.pieces))

    def residuals(self, x: np.ndarray) -> list[np.ndarray]:
        """Weighted residuals of each piece, shape (len(keep), dof)."""
        effects = self.slots.named(x)
        out = []
        for piece, motion in zip(self.pieces, self.motions, strict=True):  # pyright: ignore
            rest = self.problem.reduce(piece, piece.tau - torque_with(motion, effects))
            out.append(rest * piece.counts / self.sigma)
        return out

    def jacobian(self, x: np.ndarray, free: np.ndarray) -> list[np.ndarray]:
        """Derivatives of the residuals, shape (len(keep), dof, n_free)."""
        base = self.residuals(x)
        columns: list[list[np.ndarray]] = []
        _, upper = self.slots.bounds()
        for i in np.flatnonzero(free):
            step = DIFFERENCE * max(abs(x[i]), 1e-2)
            if x[i] + step > upper[i]:
                step = -step
            moved = x.copy()
            moved[i] += step
            columns.append([(m - b) / step for m, b in zip(self.residuals(moved), base, strict=True)])
        return [np.stack([c[n] for c in columns], axis=2) for n in range(len(base))]

    def descend(self, x: np.ndarray, free: np.ndarray) -> np.ndarray:
        """Bounded Gauss–Newton with step halving; parameters that are not free stay."""
        if not free.any():
            return x
        lower, upper = (b[free] for b in self.slots.bounds())
        rest = self.residuals(x)
        error = power_of_all(rest)
        for _ in range(STEPS):
            gram, moment = normal(self.jacobian(x, free), rest)
            step = bounded_step(gram, -moment, lower - x[free], upper - x[free])
            for shrink in (1.0, 0.5, 0.25, 0.1, 0.03):
                trial = x.copy()
                trial[free] = np.clip(x[free] + shrink * step, lower, upper)
                moved = self.residuals(trial)
                if power_of_all(moved) < error:
                    break
            else:
                return x
            gain, x, rest, error = error - power_of_all(moved), trial, moved, power_of_all(moved)
            if gain < DONE * error:
                break
        return x

    def covariance(self, x: np.ndarray) -> tuple[np.ndarray, int]:
        """Sandwich of block scores, and the number of blocks: residuals that hang together widen the intervals."""
        rest, jacobian = self.residuals(x), self.jacobian(x, np.ones(x.size, dtype=bool))
        gram, _ = normal(jacobian, rest)
        bread = inverse(gram)
        scores = []
        for r, j, blocks in zip(rest, jacobian, blocks_of(self.problem, self.pieces), strict=True):
            scores.extend(np.einsum("njk,nj->k", j[rows], r[rows]) for rows in blocks)
        table = np.array(scores)
        freedom = max(2, len(table) - 1)
        inflation = len(table) / max(1.0, len(table) - np.sqrt(x.size) - 1)
        robust = bread @ (table.T @ table) @ bread * inflation
        count = sum(p.counts.sum() for p in self.pieces)
        plain = bread * power_of_all(rest) / max(1.0, count - x.size)
        variance = np.diag(robust)
        known = variance > 1e-200  # where the data say anything of a coordinate
        widest = np.ones(x.size)
        widest[known] = np.maximum(np.sqrt(np.diag(plain)[known] / variance[known]), 1.0)
        return robust * widest[:, None] * widest[None, :], freedom


def _made_consistent(work: _Work, x: np.ndarray) -> np.ndarray:
    """Replaces bodies that no mass can have by the nearest that one can, and refits the rest around them.

    Making one body consistent moves the others, so each is given a second chance; from then on it is held.
    """
    tried, held = set[int](), np.zeros(x.size, dtype=bool)
    while (n := _impossible_body(work, x)) is not None:
        own = _own(work, x, n)
        x = x.copy()
        x[own] = _nearest(work, x, n)
        held[own] = n in tried
        tried.add(n)
        x = work.descend(x, ~(held | np.isin(np.arange(x.size), own)))
    return x


def _impossible_body(work: _Work, x: np.ndarray) -> int | None:
    """The first effect whose body no mass can have."""
    for n, effect in enumerate(work.slots.effects):
        is_body = effect.effect in ("payload", "link_inertia")
        if is_body and not is_physically_consistent(body_before(work.problem, effect) + x[_own(work, x, n)]):
            return n
    return None


def _own(work: _Work, x: np.ndarray, n: int) -> np.ndarray:
    return np.arange(x.size)[work.slots.of(n)][:BODY]


def _nearest(work: _Work, x: np.ndarray, n: int) -> np.ndarray:
    """Coordinates of the nearest body that some mass has, all else being refitted around it."""
    own, base = _own(work, x, n), body_before(work.problem, work.slots.effects[n])
    gram, _ = normal(work.jacobian(x, np.ones(x.size, dtype=bool)), work.residuals(x))
    rest = np.setdiff1d(np.arange(x.size), own)
    cross = gram[np.ix_(own, rest)]
    schur = gram[np.ix_(own, own)] - (cross @ inverse(gram[np.ix_(rest, rest)]) @ cross.T if rest.size else 0.0)
    return nearest_body(0.5 * (schur + schur.T), base + x[own], base) - base


def _intervals(
    slots: _Slots, x: np.ndarray, covariance: np.ndarray, freedom: int
) -> tuple[dict[str, tuple[float, float]], ...]:
    width = float(student.ppf(0.975, freedom))
    out = []
    for n in range(len(slots.effects)):
        effect, at = slots.effects[n], slots.of(n)
        here = effect.at_coordinates(x[at]).parameters()
        slopes = slopes_of(effect, x[at])
        variance = np.einsum("pk,kl,pl->p", slopes, covariance[at, at], slopes)
        spread_of = dict(zip(here, width * np.sqrt(np.maximum(variance, 0.0)), strict=True))
        out.append({k: (float(x - spread_of[k]), float(x + spread_of[k])) for k, x in here.items()})
    return tuple(out)
