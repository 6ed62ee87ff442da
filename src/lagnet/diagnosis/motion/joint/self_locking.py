"""K₋ < 1 wherever the load itself moved a joint: a gear with K₋ ≥ 1 holds every load, however large.

A load that drives a joint whose motor pushes against the motion, or not at all, must overcome K₋ |load|; if the speed
does not fall meanwhile, no inertia does it. So a fitted K₋ ≥ 1 beside such a motion is refuted: it stands for another
cause. Source: Duclusaud et al. 2025 (friction by the direction of power).
"""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.motion.problem import SMOOTHING
from lagnet.recordings.sampling import median_step
from lagnet.rollout.one_joint import JointSeries
from lagnet.servos.catalogue import servo_effect
from lagnet.servos.effect import ServoEffect
from lagnet.servos.parameters import BIAS, DELAY, DRIVEN, NAMES

SELF_LOCKING = "load_moved_the_joint"  # rule: K₋ ≥ 1 although the load moved the joint
HOLDS = 1.0  # K₋ from which on a gear holds every load
LEAST_LOAD = 0.2  # of the greatest load, below which the load's own error may have the other sign


def moved_by_load(series: JointSeries, speed: np.ndarray, moving: np.ndarray, law: np.ndarray) -> bool:
    """Whether the load drove the joint for `SMOOTHING` seconds against its motor, at a speed that does not fall.

    Args:
        series: of the joint.
        speed: smoothed, shape (n,).
        moving: shape (n,), mask of samples in motion.
        law: whose delay and bias say what the motor did, shape (len(LAW),).
    """
    side, sample = np.sign(speed), median_step(series.time)
    late = max(0, round(float(law[DELAY]) / sample))
    delayed = np.concatenate([series.command[:1].repeat(late), series.command[: len(speed) - late]])
    on = series.enabled > 0.5
    pushes = [on & (side * (u - series.q - law[BIAS]) > 0.0) for u in (series.command, delayed)]
    driven = moving & (side * series.load < -LEAST_LOAD * np.abs(series.load).max()) & ~pushes[0] & ~pushes[1]
    driven &= np.gradient(np.abs(speed)) >= 0.0
    return _longest(driven) * sample >= SMOOTHING


def _longest(mask: np.ndarray) -> int:
    """Length of the longest unbroken stretch."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(int)))
    return int((edges[1::2] - edges[::2]).max(initial=0))


def friction_when_driven(effect: ServoEffect, law: np.ndarray) -> float:
    """K₋ of an effect's law; 0 for an effect without."""
    return float(law[DRIVEN]) if any(NAMES[DRIVEN] in group for group in effect.frees) else 0.0


def holds_every_load(name: str, law: np.ndarray) -> bool:
    """Whether a gear with this effect of a law would hold every load by itself."""
    return friction_when_driven(servo_effect(name), law) >= HOLDS
