"""Dry friction alone of a motor that turns with two joints."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

NAME = "coupled_transmission"
JOINT, DRY = 1, 4.0  # [N m]
BLUR = 0.01  # [rad/s]


def rubbing(ratio: float) -> Callable[..., np.ndarray]:
    """The law of a motor with so many turns with the joint before, over its own."""

    def law(q, v, a, body):
        out = np.zeros_like(q)
        out[:, JOINT] = DRY * np.tanh((v[:, JOINT] + ratio * v[:, JOINT - 1]) / BLUR)
        out[:, JOINT - 1] = ratio * out[:, JOINT]
        return out

    return law
