"""q(t; x), a family of motions: segments of poses, with strokes, sweeps, sines or a hold in each.

The decision vector x has components between 0 and 1, so that a random search can draw and change it without knowing
them; limits hold for any x.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.experiment_design.motion_limits import MotionLimits
from lagnet.recordings.conditioning.smoothing import derivative
from lagnet.types import JointVector, Samples, Trajectory

SEGMENTS = 5  # poses, one after the other
DURATION = 6.0  # [s] of a segment
MOVE = 2.0  # [s] of a segment for moving to its pose
EASE = 0.6  # [s] over which the strokes of a segment begin and end
PAUSE = 0.3  # [s] of rest at the end of a segment
SLOWEST, FASTEST = 0.2, 1.0  # [Hz] of the strokes
N_VARIABLES = 6  # for a joint in a segment: pose, reach, tempo, squareness, phase, overtone
POSE_RANGE = 0.9  # of half the position range, for poses; the remainder is room for strokes
HELD = 0.2  # component of reach up to which the joint is held
SQUAREST = 0.98  # of a sine, before the arcsine makes it a stroke of constant speed
SHRINKING = (1.0, 0.7, 0.45, 0.25, 0.1, 0.03)  # factors on a motion whose torque is too large


@dataclass(frozen=True, eq=False)
class CandidateMotion:
    """Joint motion on an even clock from rest to rest: time (n,) [s], q, v, a (n, dof) [rad, rad/s, rad/s²]."""

    time: Samples
    q: Trajectory
    v: Trajectory
    a: Trajectory


def draw_decision_vector(n_dof: int, rng: np.random.Generator) -> np.ndarray:
    """x of a random motion, shape (SEGMENTS, dof, N_VARIABLES)."""
    return rng.uniform(size=(SEGMENTS, n_dof, N_VARIABLES))


def change_decision_vector(decision_vector: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """x with the components of one joint, or of one segment, perturbed or drawn again."""
    changed = decision_vector.copy()
    place = (
        (rng.integers(SEGMENTS), slice(None))
        if rng.uniform() < 0.5
        else (slice(None), rng.integers(decision_vector.shape[1]))
    )
    part = decision_vector[place]
    redrawn = rng.uniform(size=part.shape)
    perturbed = np.clip(part + 0.15 * rng.standard_normal(part.shape), 0.0, 1.0)
    changed[place] = np.where(rng.uniform(size=part.shape) < 0.3, redrawn, perturbed)
    return changed


def motion_of(decision_vector: np.ndarray, limits: MotionLimits, rate: float, shrink: float = 1.0) -> CandidateMotion:
    """q(t; x), inside the limits of position, speed and acceleration.

    Args:
        decision_vector: x, shape (SEGMENTS, dof, N_VARIABLES).
        limits: of every joint.
        rate: samples a second [Hz].
        shrink: of all excursions towards the middle of the range.
    """
    time = np.arange(round(SEGMENTS * DURATION * rate)) / rate
    half = 0.5 * (limits.upper - limits.lower)
    poses = half * POSE_RANGE * (2.0 * decision_vector[:, :, 0] - 1.0)
    moves = _within(limits, time, _between_poses(time, poses))
    strokes = np.zeros_like(moves)
    for segment in range(SEGMENTS):
        rows = (time >= segment * DURATION) & (time < (segment + 1) * DURATION)
        room = half - np.abs(poses[segment])
        strokes[rows] = _strokes(time[rows] - segment * DURATION, decision_vector[segment], half, room)
        strokes[rows] = _within(limits, time[rows], strokes[rows])
    x = _within(limits, time, shrink * (moves + strokes))
    v = derivative(time, x)
    return CandidateMotion(time, limits.middle + x, v, derivative(time, v))


def _within(limits: MotionLimits, time: Samples, x: Trajectory) -> Trajectory:
    """A signal scaled down where its speed or acceleration exceeds the limits, shape (n, dof)."""
    v = derivative(time, x)
    return x * np.minimum(1.0, np.minimum(_share(limits.speed, v), _share(limits.acceleration, derivative(time, v))))


def _share(limit: JointVector, x: Trajectory) -> JointVector:
    """Factor that brings a signal under its limit, shape (dof,)."""
    return 0.98 * limit / np.maximum(np.abs(x).max(axis=0), 1e-12)


def _between_poses(time: Samples, poses: Trajectory) -> Trajectory:
    """Quintic moves from the last pose at the start of each segment, then rest, shape (n, dof)."""
    segment = np.minimum((time / DURATION).astype(int), SEGMENTS - 1)
    before = np.vstack([poses[:1], poses[:-1]])
    s = _smooth_step((time - segment * DURATION) / MOVE)[:, None]
    return before[segment] + s * (poses - before)[segment]


def _strokes(time: Samples, decision_vector: np.ndarray, half: JointVector, room: JointVector) -> Trajectory:
    """Strokes about the pose of a segment, from rest to rest, shape (n, dof); time runs from 0 to DURATION."""
    _, reach, tempo, squareness, phase, overtone = decision_vector.T
    size = np.where(reach > HELD, np.minimum(half * (reach - HELD) / (1.0 - HELD), room), 0.0)
    rate = SLOWEST * (FASTEST / SLOWEST) ** tempo
    angle = 2.0 * np.pi * (time[:, None] * rate + phase)
    shape = SQUAREST * squareness + 1e-3
    wave = np.arcsin(shape * np.sin(angle)) / np.arcsin(shape)  # a sine, or strokes of almost constant speed
    wave = (wave + overtone**2 * np.sin(3.0 * angle)) / (1.0 + overtone**2)
    window = _smooth_step((time - MOVE) / EASE) * _smooth_step((DURATION - PAUSE - time) / EASE)
    return window[:, None] * size * wave


def _smooth_step(s: np.ndarray) -> np.ndarray:
    """From 0 to 1 with speed and acceleration zero at both ends."""
    s = np.clip(s, 0.0, 1.0)
    return s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
