"""Blocks of a real arm's remainder along a plant's motion: those whose motion was like the plant's at that time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from validation.texture.remainders import RATE, Remainder, usual

BLOCK = 50  # samples: half a second
FADE = 5  # samples over which neighbouring blocks pass into each other
EVERY = 10  # samples between blocks that may be chosen
SLOW = 0.02  # of the largest usual speed: below it the sign of the velocity is blurred
NEAREST = 5  # blocks of the most similar motion, of which one is drawn


@dataclass(frozen=True, eq=False)
class Texture:
    """A real arm's remainders as a plant's joints carry them.

    Args:
        remainders: recordings of one arm.
        joints: for each joint of the plant, that of the arm.
        scale: of the remainder's size, relative to the torque's.
    """

    remainders: tuple[Remainder, ...]
    joints: tuple[int, ...]
    scale: float

    @property
    def shares(self) -> np.ndarray:
        """Root mean square over that of the joint's torque, shape (dof,)."""
        power = np.mean(np.concatenate([r.torque for r in self.remainders]) ** 2, axis=0)
        return self.scale * np.sqrt(power)[list(self.joints)]


def draw_texture(remainders: Sequence[Remainder], n_dof: int, scales: tuple[float, float], seed: int) -> Texture:
    """An arm, its joints in some order, and a size, log-uniform between two."""
    rng = np.random.default_rng([seed, 77])
    arms = sorted({r.arm for r in remainders if r.n_dof > 1 or n_dof == 1})
    arm = arms[int(rng.integers(len(arms)))]
    own = tuple(r for r in remainders if r.arm == arm)
    laps = [rng.permutation(own[0].n_dof) for _ in range(-(-n_dof // own[0].n_dof))]
    scale = float(np.exp(rng.uniform(*np.log(scales))))
    return Texture(own, tuple(int(j) for j in np.concatenate(laps)[:n_dof]), scale)


def lay(texture: Texture, q: np.ndarray, torque: np.ndarray, seed: int) -> np.ndarray:
    """The texture's torque along a motion at `RATE`, joints kept together, shape (n, dof) [N m].

    Args:
        texture: whose.
        q: shape (n, dof) [rad].
        torque: shape (n, dof), whose root mean square sets the size of each joint's texture [N m].
        seed: of the draw among similar blocks.
    """
    rng, joints = np.random.default_rng([seed, 78]), list(texture.joints)
    pool, starts = _pool(texture)
    here = _signals(q)
    out = np.zeros_like(torque)
    for first in range(0, len(q), BLOCK):
        rows = slice(max(0, first - FADE), min(len(q), first + BLOCK + FADE))
        wanted = _feature(here[rows])
        near = np.argsort(np.sum((pool - wanted) ** 2, axis=1))[:NEAREST]
        remainder, start = starts[int(rng.choice(near))]
        block = remainder.torque[start : start + rows.stop - rows.start][:, joints]
        out[rows] += block * _fade(rows, first, len(q))[:, None]
    return texture.scale * without_listed_laws(out, here, torque) * np.sqrt(np.mean(torque**2, axis=0))


def without_listed_laws(texture: np.ndarray, signals: np.ndarray, torque: np.ndarray) -> np.ndarray:
    """The texture less its part along an offset, friction, a rotor and a gain of each joint, shape (n, dof).

    A real arm differs from run to run by these; claims of them would be right, and the envelope does not hold them.
    """
    out, n_dof = np.empty_like(texture), texture.shape[1]
    for j in range(n_dof):
        v, a = signals[:, j], signals[:, n_dof + j]
        laws = np.column_stack([np.ones(len(v)), np.tanh(v / SLOW), v, v * np.abs(v), a, torque[:, j]])
        out[:, j] = texture[:, j] - laws @ np.linalg.lstsq(laws, texture[:, j], rcond=None)[0]
    return out


def _pool(texture: Texture) -> tuple[np.ndarray, list[tuple[Remainder, int]]]:
    """Features of all blocks that may be chosen, and where each begins."""
    length, starts, features = BLOCK + 2 * FADE, [], []
    columns = [*texture.joints, *(j + texture.remainders[0].n_dof for j in texture.joints)]
    for remainder in texture.remainders:
        for start in range(0, len(remainder.torque) - length, EVERY):
            starts.append((remainder, start))
            features.append(_feature(remainder.signals[start : start + length][:, columns]))
    return np.array(features), starts


def _feature(signals: np.ndarray) -> np.ndarray:
    """Means over the thirds of a block: where the motion goes, and how it changes."""
    return np.concatenate([part.mean(axis=0) for part in np.array_split(signals, 3)])


def _signals(q: np.ndarray) -> np.ndarray:
    v = np.gradient(_smooth(q), 1.0 / RATE, axis=0)
    a = np.gradient(_smooth(v), 1.0 / RATE, axis=0)
    return np.hstack([v / usual([v]), a / usual([a])])


def _smooth(signal: np.ndarray, width: int = 9) -> np.ndarray:
    padded = np.pad(signal, ((width // 2, width // 2), (0, 0)), mode="edge")
    return np.stack([np.convolve(c, np.ones(width) / width, mode="valid") for c in padded.T], axis=1)


def _fade(rows: slice, first: int, n: int) -> np.ndarray:
    """Weights of a block: sine and cosine at its edges, so that the power of two unlike blocks stays the same."""
    at = np.arange(rows.start, rows.stop)
    rise = np.clip((at - first + FADE + 0.5) / (2 * FADE), 0.0, 1.0) if first > 0 else np.ones(at.size)
    last = first + BLOCK
    fall = np.clip((last + FADE - at - 0.5) / (2 * FADE), 0.0, 1.0) if last < n else np.ones(at.size)
    return np.sin(0.5 * np.pi * rise) * np.sin(0.5 * np.pi * fall)
