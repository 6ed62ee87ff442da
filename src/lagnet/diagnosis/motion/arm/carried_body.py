"""Servo laws and the share of a body on the last link, fitted together: the values of the laws, then the share."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.motion.arm.arm_laws import ArmLaws
from lagnet.diagnosis.motion.arm.fitting import DIFFERENCE

SIZE = 0.2  # of a share, for steps and differences


@dataclass(frozen=True, eq=False)
class LoadedArm:
    """An arm whose last link carries a share of a body: 0 where it is absent, 1 where it is as first found.

    Args:
        arm: free parameters of the laws; without the body that is carried.
        body: its ten inertial parameters, shape (10,).
    """

    arm: ArmLaws
    body: np.ndarray

    @property
    def sizes(self) -> np.ndarray:
        return np.append(self.arm.sizes, SIZE)

    def read(self) -> np.ndarray:
        """The values of the start, with the whole body, shape (k + 1,)."""
        return np.append(self.arm.read(), 1.0)

    def nearest(self, values: np.ndarray) -> np.ndarray:
        """The nearest values within bounds; the share has none."""
        return np.append(self.arm.nearest(values[:-1]), values[-1])

    def errors(self, values: np.ndarray) -> list[np.ndarray]:
        return self._at(values[-1]).errors(values[:-1])

    def sensitivities(self, values: np.ndarray, here: list[np.ndarray]) -> list[np.ndarray]:
        """∂q̂_j/∂x in units of the sizes: of each joint by its own parameters, and by the share; each (n, k + 1)."""
        own = self._at(values[-1]).sensitivities(values[:-1], here)
        moved = self.errors(values + np.append(np.zeros(values.size - 1), DIFFERENCE * SIZE))
        return [np.column_stack([o, (m - e) / DIFFERENCE]) for o, m, e in zip(own, moved, here, strict=True)]

    def _at(self, share: float) -> ArmLaws:
        return replace(self.arm, body=share * self.body)
