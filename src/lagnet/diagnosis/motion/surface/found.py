"""A level surface that the motion shows, as a value."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class SurfaceFound:
    """A surface that a point of the arm touches.

    Args:
        surface: shape (len(SURFACE),), as rollouts take it.
        joint: name of the joint that moves the touching body.
        values: px, py, pz [m] in that joint's frame, h [m] above the base's origin, k [N/m], μ.
        intervals: 95 %, by name.
        named: whether it is a claim, or a part of the correction alone.
        pushed: number of joints that it pushes.
        errors: gain of the score over the same correction without it, where it touches motion that was not fitted, over
            the standard error of that gain over blocks of time.
        power: mean squared error over the variance of the motion, without and with it, in the same blocks.
        share: of the nominal arm's squared error in the same blocks that it takes away.
        scale_is_set: whether k is in N/m, or only in proportion to kp.
    """

    surface: np.ndarray
    joint: str
    values: Mapping[str, float]
    intervals: Mapping[str, tuple[float, float]]
    named: bool
    pushed: int
    errors: float
    power: tuple[float, float]
    share: float
    scale_is_set: bool
