"""Recordings of a concealed plant with the remainder of a real arm added to their torque."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from validation.plants.body import joint_names
from validation.plants.catalogue.plan import Plan
from validation.plants.catalogue.witness import Witness
from validation.plants.simulate import add_torque
from validation.texture.remainders import Remainder
from validation.texture.resample import Texture, draw_texture, lay

SCALES = (0.1, 1.0)  # of what a real arm leaves


@dataclass(frozen=True, eq=False)
class RealTexture:
    """Adds to each plant the remainder of one real arm, drawn by the plant's seed."""

    remainders: tuple[Remainder, ...]

    def __call__(self, plan: Plan, folder: Path, witness: Witness) -> Witness:
        """Changes the recordings in the folder; what they show of each cause beside noise and texture."""
        texture = self.of(plan)
        for index, name in enumerate(plan.recordings):
            add(texture, folder / f"{name}.csv", plan.seed + 1000 * index)
        return seen_beside(texture.shares, plan, witness)

    def of(self, plan: Plan) -> Texture:
        """The texture of a plant."""
        return draw_texture(self.remainders, len(joint_names(plan.robot)), SCALES, plan.seed)


def add(texture: Texture, path: Path, seed: int) -> None:
    """Write a recording again, its torque with the texture."""
    add_torque(path, lambda q, tau: lay(texture, q, tau, seed))


def seen_beside(shares: np.ndarray, plan: Plan, witness: Witness) -> Witness:
    """The witness with each cause's torque held against noise and texture together, at its joint.

    A cause of the whole arm is held against the least texture of all joints: it may show anywhere.
    """
    joints = list(joint_names(plan.robot))
    sights = []
    for hidden, sight in zip(plan.hidden, witness.sights, strict=True):
        share = shares.min() if hidden.joint is None else shares[joints.index(hidden.joint)]
        sights.append(replace(sight, over_noise=sight.over_noise / float(np.hypot(1.0, share / plan.noise))))
    return Witness(tuple(sights))
