"""Torque errors of several models in blocks of time, so that tests count what is independent.

Of every joint the terms that no set of inertial parameters holds (an offset, viscous and dry friction) are fitted
beside each model, by block sums: SSE(w) = Σ w_b r_bᵀr_b − gᵀ G⁻¹ g with G = Σ w_b X_bᵀX_b, g = Σ w_b X_bᵀ r_b. With the
friction f that a set declares, r − X f takes the place of r and the offset alone is fitted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from lagnet.models.corrected.model import torque_along
from lagnet.recordings.conditioning.condition import Conditioned, Stretch
from lagnet.recordings.conditioning.smoothing import low_pass
from lagnet.types import JointVector, Trajectory

FEWEST, MOST = 20, 400  # blocks
SHORTEST = 0.5  # [s] of a block
MEMORY = 4.0  # correlation times that make a block
LOWEST = 0.02  # of the usual speed: below it the direction of motion is taken as blurred
BESIDE = 3  # columns that are fitted beside a model: offset, viscous, dry friction


@dataclass(frozen=True, eq=False)
class StretchErrors:
    """One stretch.

    Args:
        stretch: its motion.
        torque: shape (n, dof), recorded torque, low-passed [N m].
        errors: shape (models, n, dof), recorded less modelled torque, low-passed alike [N m].
        beside: shape (n, dof, 3), columns that are fitted beside every model.
    """

    stretch: Stretch
    torque: Trajectory
    errors: np.ndarray
    beside: np.ndarray


def stretch_errors(models: Sequence[Any], conditioned: Conditioned) -> list[StretchErrors]:
    """Errors of all models along all stretches."""
    speed = np.sqrt(np.mean(np.concatenate([s.v for s in conditioned.stretches]) ** 2, axis=0))
    blur = np.maximum(LOWEST * speed, 3.0 * conditioned.noise_v)
    return [_of_stretch(models, s, conditioned, np.maximum(blur, 1e-9)) for s in conditioned.stretches]


def _of_stretch(models: Sequence[Any], s: Stretch, conditioned: Conditioned, blur: JointVector) -> StretchErrors:
    def smooth(x: np.ndarray) -> np.ndarray:
        return low_pass(x, conditioned.rate, conditioned.bandwidth)

    torque = smooth(s.tau)
    errors = np.array([torque - smooth(torque_along(m, s.time, s.q, s.v, s.a)) for m in models])
    beside = np.stack([np.ones_like(s.v), smooth(s.v), smooth(np.tanh(s.v / blur))], axis=2)
    return StretchErrors(s, torque, errors, beside)


@dataclass(frozen=True, eq=False)
class BlockSums:
    """Sums over blocks of one joint.

    Args:
        gram: shape (blocks, 3, 3), products of the columns beside; (blocks, 1, 1) where the offset is alone.
        moment: shape (blocks, models, 3 or 1), products of the columns with the errors.
        power: shape (blocks, models), squared errors.
        torque: shape (blocks,), squared torque about its mean.
    """

    gram: np.ndarray
    moment: np.ndarray
    power: np.ndarray
    torque: np.ndarray

    def with_friction(self, friction: np.ndarray) -> BlockSums:
        """Sums with declared friction taken off and the offset alone beside; friction (models, 2): viscous, dry."""
        gram = self.gram[:, None, 1:, 1:]
        taken = np.einsum("mi,bmi->bm", friction, self.moment[:, :, 1:])
        again = np.einsum("mi,bmij,mj->bm", friction, np.broadcast_to(gram, (*taken.shape, 2, 2)), friction)
        offset = self.moment[:, :, :1] - np.einsum("mi,bi->bm", friction, self.gram[:, 0, 1:])[:, :, None]
        return BlockSums(self.gram[:, :1, :1], offset, self.power - 2.0 * taken + again, self.torque)

    def nmse(self, weights: np.ndarray) -> np.ndarray:
        """Normalised errors with blocks weighted, shapes (draws, blocks) → (draws, models)."""
        gram = np.einsum("wb,bij->wij", weights, self.gram)
        moment = np.einsum("wb,bmi->wmi", weights, self.moment)
        ridge = 1e-12 * np.trace(gram, axis1=1, axis2=2)[:, None, None] * np.eye(gram.shape[1])
        explained = np.einsum(
            "wmi,wmi->wm", moment, np.linalg.solve(gram + ridge, moment.transpose(0, 2, 1)).transpose(0, 2, 1)
        )
        left = weights @ self.power - explained
        return left / np.maximum(weights @ self.torque, 1e-300)[:, None]


def block_length(parts: Sequence[StretchErrors], rate: float) -> int:
    """Samples of a block: some correlation times of the squared errors, between half a second and a share of all."""
    total = sum(len(p.torque) for p in parts)
    longest = max(parts, key=lambda p: len(p.torque))
    signal = np.mean(longest.errors**2, axis=0)
    signal = (signal - signal.mean(axis=0)) / np.maximum(signal.std(axis=0), 1e-300)
    n = len(signal)
    spectrum = np.abs(np.fft.rfft(signal, 2 * n, axis=0)) ** 2
    correlation = np.fft.irfft(spectrum, axis=0)[:n] / n
    crossing = [int(np.argmax(c < np.exp(-1.0))) if np.any(c < np.exp(-1.0)) else n for c in correlation.T]
    wished = max(MEMORY * max(crossing), SHORTEST * rate)
    return int(np.clip(wished, max(total / MOST, 2), max(total / FEWEST, 2)))


def block_sums(parts: Sequence[StretchErrors], joint: int, length: int) -> BlockSums:
    """Sums of one joint over blocks of so many samples."""
    gram, moment, power, torque = [], [], [], []
    mean = np.mean(np.concatenate([p.torque[:, joint] for p in parts]))
    for part in parts:
        for start in range(0, len(part.torque), length):
            rows = slice(start, start + length)
            X, r = part.beside[rows, joint], part.errors[:, rows, joint]
            gram.append(X.T @ X)
            moment.append(r @ X)
            power.append(np.sum(r**2, axis=1))
            torque.append(np.sum((part.torque[rows, joint] - mean) ** 2))
    return BlockSums(np.array(gram), np.array(moment), np.array(power), np.array(torque))
