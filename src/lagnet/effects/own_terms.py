"""What a joint may add to its torque by itself whatever the bodies are: taken off signals before these are compared."""

from __future__ import annotations

import numpy as np

from lagnet.effects.motion import Motion


def beside_own_terms(motion: Motion, joint: int, signals: np.ndarray) -> np.ndarray:
    """Signals of a joint, shape (n, k), less their parts along an offset, dry and viscous friction, and a rotor."""
    v = motion.v[:, joint]
    own = np.column_stack([np.ones_like(v), np.tanh(v / motion.slow[joint]), v, motion.a[:, joint]])
    own, _ = np.linalg.qr(own / np.maximum(np.linalg.norm(own, axis=0), 1e-12))
    return signals - own @ (own.T @ signals)
