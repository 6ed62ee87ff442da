"""A joint that moves and rests in turns, and keeps a share of its dry friction at rest; further joints have none."""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.models.corrected.named_effects import NamedEffect

DRY, SHARE, RATE = 3.0, 0.6, 100.0
COULOMB = NamedEffect("coulomb_friction", 0, {"Fc": DRY})


def stop_and_go(joints: int = 1) -> Problem:
    """Two seconds of motion and two of rest, ten times, every other one in the other direction."""
    time = np.arange(int(40 * RATE)) / RATE
    v, torque = np.zeros((2, time.size, joints))
    sense = np.where(time % 8.0 < 4.0, 1.0, -1.0)
    v[:, 0] = np.where(time % 4.0 < 2.0, np.sin(np.pi * (time % 4.0) / 2.0), 0.0) * sense
    torque[:, 0] = DRY * np.where(v[:, 0] == 0.0, SHARE * sense, np.sign(v[:, 0]))
    none = np.zeros_like(v)
    keep = np.arange(50, time.size - 50, 5)
    piece = Segment(time, none, v, none, torque, none, 0, keep, (v != 0.0)[keep])
    names = tuple(f"joint{k + 1}" for k in range(joints))
    return Problem(None, (piece,), (piece,), RATE, 10.0, np.full(joints, 0.01), names)
