"""How a joint position enters a network: on the circle where the joint wraps, else on its recorded range."""

from __future__ import annotations

from dataclasses import dataclass, replace

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from lagnet.errors import ModelError

JOINT_TYPES = ("continuous", "revolute", "prismatic")


@dataclass(frozen=True)
class JointFeatures:
    """Position features of each joint, with the constants that put them at mean 0 and size 1 on the training data.

    A continuous joint gives (sin q, cos q). A bounded revolute joint gives the same two, turned to the middle of its
    range and standardised, so that a narrow range still fills the network's input. A prismatic joint gives its scaled
    position.

    Args:
        joint_types: one of JOINT_TYPES for each joint.
        centre: middle of the recorded range of each joint [rad] or [m].
        offset: mean of each feature; scale: its standard deviation.
    """

    joint_types: tuple[str, ...]
    centre: tuple[float, ...]
    offset: tuple[float, ...]
    scale: tuple[float, ...]

    @property
    def owner(self) -> tuple[int, ...]:
        """The joint that each feature comes from."""
        return tuple(_rows(self.joint_types))

    @property
    def on_circle(self) -> JointFeatures:
        """The same with the sine and cosine of every turning joint as they are, never above 1.

        For networks that multiply features of many joints: a product of standardised features has a tail that grows
        with every joint, while the torque of rigid bodies is made of products of plain sines and cosines.
        """
        turns = [self.joint_types[j] != "prismatic" for j in self.owner]
        offset = tuple(0.0 if turn else x for turn, x in zip(turns, self.offset, strict=True))
        scale = tuple(1.0 if turn else x for turn, x in zip(turns, self.scale, strict=True))
        return replace(self, offset=offset, scale=scale)

    def __call__(self, q: Array) -> Array:
        """Features of one position (dof,), shape (n_features,)."""
        raw = _raw(q - np.asarray(self.centre, q.dtype), self.joint_types)
        return (raw - np.asarray(self.offset, q.dtype)) / np.asarray(self.scale, q.dtype)


def _rows(joint_types: tuple[str, ...]) -> list[int]:
    return [j for j, kind in enumerate(joint_types) for _ in range(1 if kind == "prismatic" else 2)]


def _raw(x: Array, joint_types: tuple[str, ...]) -> Array:
    """Sine and cosine of each turning joint, position of each sliding one, in joint order."""
    stacked = jnp.concatenate([jnp.sin(x), jnp.cos(x), x])
    n = len(joint_types)
    pick = [i for j, kind in enumerate(joint_types) for i in ((2 * n + j,) if kind == "prismatic" else (j, n + j))]
    return stacked[np.asarray(pick)]


def fit_features(q: np.ndarray, joint_types: tuple[str, ...]) -> JointFeatures:
    """Choose the constants from recorded positions, shape (n, dof) [rad] or [m].

    Raises:
        ModelError: a joint type is unknown, or there is not one for each joint.
    """
    if len(joint_types) != q.shape[1]:
        raise ModelError(f"{len(joint_types)} joint types for {q.shape[1]} joints", next_step="give one for each joint")
    for kind in joint_types:
        if kind not in JOINT_TYPES:
            raise ModelError(f"joint type {kind!r} is unknown", choices=JOINT_TYPES)
    wraps = np.array([kind == "continuous" for kind in joint_types])
    centre = np.where(wraps, 0.0, 0.5 * (q.min(axis=0) + q.max(axis=0)))
    raw = _columns(q - centre, joint_types)
    circle = wraps[_rows(joint_types)]
    offset = np.where(circle, 0.0, raw.mean(axis=0))
    scale = np.where(circle, 1.0, np.maximum(raw.std(axis=0), 1e-6))
    return JointFeatures(tuple(joint_types), *(tuple(x.tolist()) for x in (centre, offset, scale)))


def _columns(x: np.ndarray, joint_types: tuple[str, ...]) -> np.ndarray:
    parts = [
        [x[:, j]] if kind == "prismatic" else [np.sin(x[:, j]), np.cos(x[:, j])] for j, kind in enumerate(joint_types)
    ]
    return np.stack([column for part in parts for column in part], axis=1)


def guess_joint_types(q: np.ndarray) -> tuple[str, ...]:
    """Call a joint continuous where seen over more than half a turn, else revolute; sliding joints must be named."""
    return tuple("continuous" if span > np.pi else "revolute" for span in np.ptp(q, axis=0))
