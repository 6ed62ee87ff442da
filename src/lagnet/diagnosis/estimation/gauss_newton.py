"""x ← x − (Σ JᵀJ)⁺ Σ Jᵀe, bounded: Gauss–Newton on the weighted residuals e(x), and their sandwich covariance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from lagnet.diagnosis.estimation.slots import Slots
from lagnet.diagnosis.estimation.superposition import Superposition
from lagnet.diagnosis.problem.problem import Problem, Segment, spread_evenly
from lagnet.diagnosis.regression.block_gram import block_length
from lagnet.diagnosis.regression.normal_equations import (
    bounded_step,
    inverse_where_told,
    moment_of,
    normal,
    power_of_all,
)
from lagnet.effects.motion import Motion
from lagnet.models.corrected.named_effects import NamedEffect, torque_with
from lagnet.recordings.sampling import median_step

STEPS = 12  # Gauss–Newton steps at most; a handful suffice from the search's start
DONE = 1e-6  # relative change of the error at which the steps end
SHRINKS = (1.0, 0.5, 0.25, 0.1, 0.03)  # of a step, until one lowers the error
MOST_SAMPLES = 60_000  # of the full rate: longer recordings are refitted on segments spread over them
DIFFERENCE = 1e-4  # relative step of the derivatives by finite differences
NOT_SAID = 1e6  # standard deviation reported of a coordinate that recordings do not determine, in its unit


def spread(pieces: Sequence[Segment], most: int = MOST_SAMPLES) -> tuple[Segment, ...]:
    """The segments that a refit uses."""
    return spread_evenly(pieces, most)


def blocks_of(problem: Problem, pieces: Sequence[Segment]) -> list[list[np.ndarray]]:
    """Rows of each block of time of each segment, long compared with the correlation time of the residual."""
    rate = problem.rate / max(1, int(median_step(pieces[0].keep)))
    length = block_length(sum(p.keep.size for p in pieces), rate, problem.bandwidth)
    counts = [max(1, round(p.keep.size / length)) for p in pieces]
    return [np.array_split(np.arange(p.keep.size), n) for p, n in zip(pieces, counts, strict=True)]


@dataclass(frozen=True, eq=False)
class GaussNewton:
    """A refit's data: segments of the problem, the noise σ of each joint and the place of each coordinate.

    `held`, shape (k,), tells which coordinates stay as they are given, without an interval; `beside` what acts as well,
    and is not refitted.
    """

    problem: Problem
    pieces: tuple[Segment, ...]
    sigma: np.ndarray
    slots: Slots
    held: np.ndarray
    beside: tuple[NamedEffect, ...] = ()
    known: dict[bytes, tuple[list[np.ndarray], list[np.ndarray]]] = field(default_factory=dict, init=False, repr=False)

    @cached_property
    def motions(self) -> tuple[Motion, ...]:
        """The segments as the effects see them."""
        return tuple(p.motion(self.problem) for p in self.pieces)

    def residuals(self, x: np.ndarray) -> list[np.ndarray]:
        """e = F(τ − τ_nominal − Σ τ_effect(x)) / σ of each segment, shape (len(keep), dof)."""
        effects = (*self.beside, *self.slots.named(x))
        out = []
        for piece, motion in zip(self.pieces, self.motions, strict=True):
            residual = self.problem.reduce(piece, piece.tau - torque_with(motion, effects))
            out.append(residual * piece.counts / self.sigma)
        return out

    def linear(self, x: np.ndarray) -> tuple[list[np.ndarray], list[np.ndarray]]:
        """e and ∂e/∂x of all coordinates; kept for the last x, at which bodies and intervals ask for the same."""
        key = x.tobytes()
        if key not in self.known:
            found = self.residuals(x), self.jacobian(x, np.ones(x.size, dtype=bool))
            self.known.clear()
            self.known[key] = found
        return self.known[key]

    def jacobian(self, x: np.ndarray, free: np.ndarray) -> list[np.ndarray]:
        """∂e/∂x of each segment by finite differences, shape (len(keep), dof, n_free)."""
        named = self.slots.named(x)
        sums = [Superposition(motion, (*self.beside, *named)) for motion in self.motions]
        moves = [self._moved(x, int(i), named) for i in np.flatnonzero(free)]
        return [self._slopes(*pair, moves) for pair in zip(self.pieces, sums, strict=True)]

    def _moved(
        self, x: np.ndarray, i: int, named: Sequence[NamedEffect]
    ) -> tuple[float, int | None, NamedEffect | None]:
        """Step of a coordinate, number of the effect that it changes, and that effect; None where nothing changes."""
        step = self._step(x, i)
        n, after = self.slots.changed(x, i, x[i] + step)
        unmoved = self.held[i] or after.key == named[n].key
        return (step, None, None) if unmoved else (step, len(self.beside) + n, after)

    def _slopes(self, piece: Segment, total: Superposition, moves: Sequence[tuple]) -> np.ndarray:
        """∂e/∂x of one segment; all its columns are filtered together."""
        table = np.zeros((piece.keep.size, self.problem.n_dof, len(moves)))
        changes = [({} if n is None else total.change(n, other), step) for step, n, other in moves]
        places = [(j, column) for column, (change, _) in enumerate(changes) for j in change]
        if not places:
            return table
        moved = self.problem.reduce(piece, np.column_stack([changes[c][0][j] / changes[c][1] for j, c in places]))
        for (j, column), signal in zip(places, moved.T, strict=True):
            table[:, j, column] = -signal * piece.counts[:, j] / self.sigma[j]
        return table

    def _step(self, x: np.ndarray, i: int) -> float:
        """By how much a coordinate moves, away from its upper bound."""
        step = DIFFERENCE * max(abs(x[i]), 1e-2)
        return -step if x[i] + step > self.slots.bounds[1][i] else step

    def descend(self, x: np.ndarray, free: np.ndarray) -> np.ndarray:
        """Bounded Gauss–Newton with step halving; parameters that are not free stay.

        Derivatives cost many times what residuals do: each serves for two steps, and the steps end where fresh ones
        foresee no noticeable gain, so that those at the end are known.
        """
        for _ in range(STEPS if free.any() else 0):
            residual, whole = self.linear(x)
            jacobian = [j[..., free] for j in whole]
            gram, moment = normal(jacobian, residual)
            step, error = self._bounded(x, free, gram, moment), power_of_all(residual)
            if -(2.0 * moment + gram @ step) @ step < DONE * error:
                return x
            moved = self._lower(x, free, step, error, SHRINKS)
            if moved is None:
                return x
            x, residual = moved
            step = self._bounded(x, free, gram, moment_of(jacobian, residual))
            again = self._lower(x, free, step, power_of_all(residual), SHRINKS[:1])
            x = x if again is None else again[0]
        return x

    def _bounded(self, x: np.ndarray, free: np.ndarray, gram: np.ndarray, moment: np.ndarray) -> np.ndarray:
        lower, upper = (b[free] for b in self.slots.bounds)
        return bounded_step(gram, -moment, lower - x[free], upper - x[free])

    def _lower(
        self, x: np.ndarray, free: np.ndarray, step: np.ndarray, error: float, shrinks: Sequence[float]
    ) -> tuple[np.ndarray, list[np.ndarray]] | None:
        """The first of the shrunk steps that lowers the error, with its residuals; None where none does."""
        lower, upper = (b[free] for b in self.slots.bounds)
        for shrink in shrinks:
            trial = x.copy()
            trial[free] = np.clip(x[free] + shrink * step, lower, upper)
            residual = self.residuals(trial)
            if power_of_all(residual) < error:
                return trial, residual
        return None

    def covariance(self, x: np.ndarray) -> tuple[np.ndarray, int]:
        """A⁻¹ (Σ_b J_bᵀe_b e_bᵀJ_b) A⁻¹, A = Σ_b J_bᵀJ_b, and the number of blocks b.

        Residuals that are correlated in time within a block widen the intervals.
        """
        residual, jacobian = self.linear(x)
        gram, _ = normal(jacobian, residual)
        bread, open_ = inverse_where_told(gram)
        scores = []
        for r, j, blocks in zip(residual, jacobian, blocks_of(self.problem, self.pieces), strict=True):
            scores.extend(np.einsum("njk,nj->k", j[rows], r[rows]) for rows in blocks)
        table = np.array(scores)
        freedom = max(2, len(table) - 1)
        inflation = len(table) / max(1.0, len(table) - np.sqrt(x.size) - 1)
        robust = bread @ (table.T @ table) @ bread * inflation
        count = sum(p.counts.sum() for p in self.pieces)
        plain = bread * power_of_all(residual) / max(1.0, count - x.size)
        variance = np.diag(robust)
        known = variance > 1e-200  # where the data say anything of a coordinate
        open_ |= ~known & self.slots.of_bodies()
        widest = np.ones(x.size)
        widest[known] = np.maximum(np.sqrt(np.diag(plain)[known] / variance[known]), 1.0)
        robust *= widest[:, None] * widest[None, :]
        robust[open_, :] = robust[:, open_] = 0.0
        robust[open_, open_] = NOT_SAID**2
        return robust, freedom


def start_gauss_newton(
    problem: Problem,
    effects: Sequence[NamedEffect],
    sigma: np.ndarray,
    choices_stay: bool = True,
    beside: Sequence[NamedEffect] = (),
) -> tuple[GaussNewton, np.ndarray]:
    """The work of a refit, and the coordinates of the effects as given."""
    parts = [e.coordinates() for e in effects]
    slots = Slots(tuple(effects), np.concatenate([[0], np.cumsum([p.size for p in parts])]))
    held = slots.chosen() & choices_stay
    return GaussNewton(problem, spread(problem.fit), sigma, slots, held, tuple(beside)), np.concatenate(parts)
