"""How much of ε is kept on each joint: as much as torque that was not trained on bears out.

With mechanics given, the share s of ε that leaves least of the held-out torque is a least-squares factor; between 0
and 1 it shrinks an ε that fits its training samples better than others. Where even the best share gains no more than
the gain differs by chance from one stretch of the held-out samples to another, ε is noise and nothing of it is kept.
"""

from __future__ import annotations

import numpy as np

from lagnet.types import Trajectory

STRETCHES = 20  # of consecutive held-out rows: samples of one motion are alike, stretches of a motion are less so
SURE = 2.0  # standard errors by which the mean gain of a stretch must exceed zero


def shares(left: Trajectory, epsilon: Trajectory) -> np.ndarray:
    """Share of ε to keep on each joint, shape (dof,), 0 … 1.

    Args:
        left: held-out torque less mechanics, shape (n, dof) [N m], rows in the order of the recordings.
        epsilon: ε at the same samples, shape (n, dof) [N m].
    """
    power = np.sum(epsilon**2, axis=0)
    best = np.sum(epsilon * left, axis=0) / np.where(power > 0, power, 1.0)
    share = np.clip(best, 0.0, 1.0)
    gain = left**2 - (left - share * epsilon) ** 2
    means = np.array([part.mean(axis=0) for part in np.array_split(gain, min(STRETCHES, len(gain)))])
    error = means.std(axis=0, ddof=1) / np.sqrt(len(means))
    return np.where(means.mean(axis=0) > SURE * error, share, 0.0)
