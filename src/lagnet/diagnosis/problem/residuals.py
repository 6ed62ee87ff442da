"""The residual: measured torque less that of the nominal model with effects, low-passed and decimated alike.

r = F(τ − τ_nominal − Σ τ_effect), with F the zero-phase low-pass of the diagnosis.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.effects.catalogue import effect_named
from lagnet.effects.effect import StateEffect
from lagnet.effects.motion import Motion
from lagnet.models.corrected.named_effects import NamedEffect, torque_with

FORGOTTEN = 0.05  # share of the state at the first sample, below which it does not matter


@dataclass(frozen=True, eq=False)
class RecordingResidual:
    """r(t) of one recording at its valid samples, after decimation.

    Args:
        motion: at the samples that are kept; its recording is the fitted one that it belongs to, None for another.
        residual: shape (n, dof), r of the model with its effects, low-passed [N m].
        valid: shape (n, dof), False where a joint is at rest, or depends on a state that no recording tells.
        index: of the recording among those fitted, or among those held out.
    """

    motion: Motion
    residual: np.ndarray
    valid: np.ndarray
    index: int

    @property
    def time(self) -> np.ndarray:
        """Clock of the recording at the samples, shape (n,) [s]."""
        return self.motion.time

    def thinned(self, step: int) -> RecordingResidual:
        """Every so many of the samples."""
        m, rows = self.motion, slice(None, None, step)
        motion = replace(m, time=m.time[rows], q=m.q[rows], v=m.v[rows], a=m.a[rows], load=m.load[rows], cache={})
        return RecordingResidual(motion, self.residual[rows], self.valid[rows], self.index)


def log_of_powers(power: Sequence[float] | np.ndarray, noise: np.ndarray) -> float:
    """Σ_j ln max(p_j, σ_j²) of mean square residuals p, shape (dof,) [N² m²]; a third at any joint weighs the same."""
    return float(np.sum(np.log(np.maximum(power, np.maximum(noise, 1e-12) ** 2))))


def residual_by_recording(
    problem: Problem, pieces: Sequence[Segment], effects: Sequence[NamedEffect]
) -> tuple[RecordingResidual, ...]:
    """r = F(τ − τ_nominal − Σ τ_effect) of each recording, its segments joined in time."""
    parts: dict[int, list[tuple[Segment, np.ndarray]]] = {}
    for piece in pieces:
        residual = problem.reduce(piece, piece.tau - torque_with(piece.motion(problem), effects))
        parts.setdefault(piece.recording, []).append((with_known_state(problem, piece, effects), residual))
    return tuple(_joined(problem, index, found) for index, found in parts.items())


def with_known_state(problem: Problem, piece: Segment, effects: Sequence[NamedEffect]) -> Segment:
    """The segment with the samples at which effects with memory have forgotten the state that they began in."""
    counts, motion = piece.counts, piece.motion(problem)
    for effect in effects:
        law = effect_named(effect.effect)
        if isinstance(law, StateEffect) and effect.joint is not None:
            known = law.left_of_start(motion, effect.joint, effect.values)[piece.keep] < FORGOTTEN
            counts = counts & (known[:, None] | (np.arange(counts.shape[1]) != effect.joint))
    return piece if counts is piece.counts else piece.with_counts(counts)


def _joined(problem: Problem, index: int, found: list[tuple[Segment, np.ndarray]]) -> RecordingResidual:
    names = ("time", "q", "v", "a", "load")
    time, q, v, a, load = (np.concatenate([getattr(p, n)[p.keep] for p, _ in found]) for n in names)
    motion = Motion(
        time, q, v, a, load, problem.slow, problem.nominal, None, None, found[0][0].origin, problem.straight
    )
    valid = np.concatenate([p.counts for p, _ in found])
    return RecordingResidual(motion, np.concatenate([r for _, r in found]), valid, index)


def left_by(problem: Problem, pieces: Sequence[Segment], effects: Sequence[NamedEffect]) -> np.ndarray:
    """r of all segments, zero where a sample is not valid, shape (n, dof) [N m]."""
    return np.concatenate([_residual(problem, p, p.motion(problem), effects) for p in pieces])


def stacked(problem: Problem, pieces: Sequence[Segment]) -> tuple[np.ndarray, np.ndarray]:
    """r = F(τ − τ_nominal) of all segments [N m] and which samples are valid, shape (n, dof) each."""
    residual = np.concatenate([problem.residual(p) for p in pieces])
    return residual, np.concatenate([p.counts for p in pieces])


def power_of(residual: np.ndarray, valid: np.ndarray, joint: int) -> float:
    """mean r_j² over the valid samples of a joint [N² m²]."""
    return float(np.sum((residual[:, joint] * valid[:, joint]) ** 2) / max(1, valid[:, joint].sum()))


def predicted_error(
    problem: Problem, pieces: Sequence[Segment], effects: Sequence[NamedEffect], measured_torque: bool = False
) -> float:
    """Σ_j mean r_j² / var τ_j: squared residual of a model with effects over each joint's variance, summed.

    Args:
        measured_torque: whether effects that follow from the measured torque may use it; a prediction has none.
    """
    residuals = []
    for piece in pieces:
        motion = piece.motion(problem)
        residuals.append(
            _residual(problem, piece, motion if measured_torque else replace(motion, recorded=None), effects)
        )
    moving = problem.scale > 1e-9 * np.max(problem.scale)
    return float(np.sum(np.mean(np.concatenate(residuals)[:, moving] ** 2, axis=0) / problem.scale[moving] ** 2))


def _residual(problem: Problem, piece: Segment, motion: Motion, effects: Sequence[NamedEffect]) -> np.ndarray:
    return problem.reduce(piece, piece.tau - torque_with(motion, effects)) * piece.counts
