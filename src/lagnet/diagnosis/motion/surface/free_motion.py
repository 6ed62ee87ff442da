"""Rollouts over many surfaces that differ from one without any only where the arm comes near them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.motion.arm.rollouts import ArmRuns
from lagnet.rollout.surface import heights_of

NEAR = 2.0  # greatest ways of the point from sample to sample: farther above a surface it has not touched it between


@dataclass(frozen=True, eq=False)
class FreeMotion:
    """Runs as laws predict them without a surface.

    Args:
        data: the runs.
        laws: shape (dof, len(LAW)); body: shape (10,), carried by the last link, or None.
        positions: of every run, each of shape (samples, dof).
    """

    data: ArmRuns
    laws: np.ndarray
    body: np.ndarray | None
    positions: list[np.ndarray]

    def errors(self, surface: np.ndarray | None = None) -> list[np.ndarray]:
        """As `ArmRuns.errors` over a surface, shape (len(SURFACE),): runs that stay clear of it are as without."""
        found = list(self.positions)
        near = [] if surface is None else [i for i, q in enumerate(found) if self._comes_near(surface, q)]
        for i, q in zip(near, self.data.positions_in(near, self.laws, self.body, surface), strict=True):
            found[i] = q
        return self.data.of_joints(found)

    def _comes_near(self, surface: np.ndarray, q: np.ndarray) -> bool:
        z = heights_of(self.data.problem.tree, surface, q)
        return not float(z.min()) > NEAR * float(np.abs(np.diff(z)).max(initial=0.0))


def free_motion(data: ArmRuns, laws: np.ndarray, body: np.ndarray | None) -> FreeMotion:
    """The rollouts of laws, shape (dof, len(LAW)), with a body, shape (10,), and no surface."""
    return FreeMotion(data, laws, body, data.positions(laws, body))
