"""What joints have in common whose link does not stand where the encoder of their motor says."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping

import numpy as np

from lagnet.effects.effect import Effect
from lagnet.effects.motion import Motion
from lagnet.effects.shifted import shifted_torque

Shift = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Position, speed and acceleration of a link less those recorded, each of shape (n,)."""


class Transmission(Effect):
    """A link that its load moves against its motor: r = τ(q + dq, v + dv, a + da) − τ(q, v, a)."""

    reaches_all = True
    instantaneous = False
    uses_load = True
    stage = "transmission"

    @abstractmethod
    def shift(self, motion: Motion, joint: int, values: Mapping[str, float]) -> Shift:
        """dq, dv and da of the link under the load of the motion."""

    def torque(self, motion: Motion, joint: int, values: Mapping[str, float]) -> np.ndarray:
        return shifted_torque(motion, joint, *self.shift(motion, joint, values))
