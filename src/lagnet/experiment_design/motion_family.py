"""Motions that could be recorded next: chapters of poses, with strokes, sweeps, sines or a hold in each.

A motion is written down as an array of genes between 0 and 1, so that a search can draw and change it blindly; limits
hold for whatever the genes say.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.experiment_design.motion_limits import MotionLimits
from lagnet.recordings.conditioning.smoothing import derivative
from lagnet.types import JointVector, Samples, Trajectory

CHAPTERS = 5  # poses, one after the other
CHAPTER = 6.0  # [s]
MOVE = 2.0  # [s] of a chapter for moving to its pose
EASE = 0.6  # [s] over which the strokes of a chapter begin and end
PAUSE = 0.3  # [s] of rest at the end of a chapter
SLOWEST, FASTEST = 0.2, 1.0  # [Hz] of the strokes
GENES = 6  # for a joint in a chapter: pose, reach, tempo, squareness, phase, overtone
POSE_RANGE = 0.9  # of half the position range, for poses; the remainder is room for strokes
HELD = 0.2  # value of the gene of reach up to which the joint is held
SQUAREST = 0.98  # of a sine, before the arcsine makes it a stroke of constant speed
SHRINKING = (1.0, 0.7, 0.45, 0.25, 0.1, 0.03)  # tried on a motion whose torque is too large


@dataclass(frozen=True, eq=False)
class CandidateMotion:
    """Joint motion on an even clock from rest to rest: time (n,) [s], q, v, a (n, dof) [rad, rad/s, rad/s²]."""

    time: Samples
    q: Trajectory
    v: Trajectory
    a: Trajectory


def draw_decision_vector(n_dof: int, rng: np.random.Generator) -> np.ndarray:
    """Genes of any motion, shape (CHAPTERS, dof, GENES)."""
    return rng.uniform(size=(CHAPTERS, n_dof, GENES))


def change_decision_vector(decision_vector: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """The genes of one joint, or of one chapter, moved a little or drawn anew."""
    changed = decision_vector.copy()
    place = (
        (rng.integers(CHAPTERS), slice(None))
        if rng.uniform() < 0.5
        else (slice(None), rng.integers(decision_vector.shape[1]))
    )
    part = decision_vector[place]
    fresh = rng.uniform(size=part.shape)
    near = np.clip(part + 0.15 * rng.standard_normal(part.shape), 0.0, 1.0)
    changed[place] = np.where(rng.uniform(size=part.shape) < 0.3, fresh, near)
    return changed


def motion_of(decision_vector: np.ndarray, limits: MotionLimits, rate: float, shrink: float = 1.0) -> CandidateMotion:
    """The motion that genes stand for, inside the limits of position, speed and acceleration.

    Args:
        genes: shape (CHAPTERS, dof, GENES).
        limits: of every joint.
        rate: samples a second [Hz].
        shrink: of all excursions towards the middle of the range.
    """
    time = np.arange(round(CHAPTERS * CHAPTER * rate)) / rate
    half = 0.5 * (limits.upper - limits.lower)
    poses = half * POSE_RANGE * (2.0 * decision_vector[:, :, 0] - 1.0)
    moves = _within(limits, time, _between_poses(time, poses))
    strokes = np.zeros_like(moves)
    for chapter in range(CHAPTERS):
        rows = (time >= chapter * CHAPTER) & (time < (chapter + 1) * CHAPTER)
        room = half - np.abs(poses[chapter])
        strokes[rows] = _strokes(time[rows] - chapter * CHAPTER, decision_vector[chapter], half, room)
        strokes[rows] = _within(limits, time[rows], strokes[rows])
    x = _within(limits, time, shrink * (moves + strokes))
    v = derivative(time, x)
    return CandidateMotion(time, limits.middle + x, v, derivative(time, v))


def _within(limits: MotionLimits, time: Samples, x: Trajectory) -> Trajectory:
    """A signal made smaller where it is too fast or too sudden, shape (n, dof)."""
    v = derivative(time, x)
    return x * np.minimum(1.0, np.minimum(_share(limits.speed, v), _share(limits.acceleration, derivative(time, v))))


def _share(limit: JointVector, x: Trajectory) -> JointVector:
    """Factor that brings a signal under its limit, shape (dof,)."""
    return 0.98 * limit / np.maximum(np.abs(x).max(axis=0), 1e-12)


def _between_poses(time: Samples, poses: Trajectory) -> Trajectory:
    """Quintic moves from the last pose at the start of each chapter, then rest, shape (n, dof)."""
    chapter = np.minimum((time / CHAPTER).astype(int), CHAPTERS - 1)
    before = np.vstack([poses[:1], poses[:-1]])
    s = _smooth_step((time - chapter * CHAPTER) / MOVE)[:, None]
    return before[chapter] + s * (poses - before)[chapter]


def _strokes(time: Samples, decision_vector: np.ndarray, half: JointVector, room: JointVector) -> Trajectory:
    """Strokes about the pose of a chapter, from rest to rest, shape (n, dof); time runs from 0 to CHAPTER."""
    _, reach, tempo, squareness, phase, overtone = decision_vector.T
    size = np.where(reach > HELD, np.minimum(half * (reach - HELD) / (1.0 - HELD), room), 0.0)
    rate = SLOWEST * (FASTEST / SLOWEST) ** tempo
    angle = 2.0 * np.pi * (time[:, None] * rate + phase)
    bent = SQUAREST * squareness + 1e-3
    wave = np.arcsin(bent * np.sin(angle)) / np.arcsin(bent)  # a sine, or strokes of almost constant speed
    wave = (wave + overtone**2 * np.sin(3.0 * angle)) / (1.0 + overtone**2)
    window = _smooth_step((time - MOVE) / EASE) * _smooth_step((CHAPTER - PAUSE - time) / EASE)
    return window[:, None] * size * wave


def _smooth_step(s: np.ndarray) -> np.ndarray:
    """From 0 to 1 with speed and acceleration zero at both ends."""
    s = np.clip(s, 0.0, 1.0)
    return s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
