"""Recordings of a concealed plant with white noise on their torque, many times that of the plant's own sensor."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from validation.plants.catalogue.plan import Plan
from validation.plants.catalogue.witness import Witness
from validation.plants.simulate import add_torque

LEAST, MOST = 0.05, 0.3  # of the standard deviation of each joint's torque
APART = 7919  # of the seeds of two recordings


@dataclass(frozen=True)
class WhiteNoise:
    """Adds white noise to the torque of every joint, its size drawn by the plant's seed."""

    def __call__(self, plan: Plan, folder: Path, witness: Witness) -> Witness:
        """Changes the recordings in the folder; what they show of each cause beside all noise."""
        share = self.share(plan)
        level = [
            self._add(folder / f"{name}.csv", share, plan.seed + APART * n) for n, name in enumerate(plan.recordings)
        ]
        more = float(np.max(level[:-1])) / plan.noise
        sights = tuple(replace(s, over_noise=s.over_noise / float(np.hypot(1.0, more))) for s in witness.sights)
        return Witness(sights)

    @staticmethod
    def share(plan: Plan) -> float:
        """σ of the noise over the standard deviation of a joint's torque, log-uniform."""
        return float(np.exp(np.random.default_rng(plan.seed).uniform(np.log(LEAST), np.log(MOST))))

    @staticmethod
    def _add(path: Path, share: float, seed: int) -> np.ndarray:
        """Adds it; its σ over the root mean square torque of each joint, shape (dof,)."""
        told = []

        def noise(_: np.ndarray, tau: np.ndarray) -> np.ndarray:
            sigma = share * tau.std(axis=0)
            told.append(sigma / np.maximum(np.sqrt(np.mean(tau**2, axis=0)), 1e-12))
            return sigma * np.random.default_rng(seed).standard_normal(tau.shape)

        add_torque(path, noise)
        return told[0]
