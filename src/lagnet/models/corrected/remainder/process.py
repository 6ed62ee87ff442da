"""ε of a Gaussian process: what remained along the fitted motion, for motion that comes back to it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.models.corrected.remainder.learned import angles, squared_distances
from lagnet.types import JointVector, Trajectory

KNOWN = 0.5  # share of the process' variance that the training motion must take away for it to speak
FIVE = np.sqrt(5.0)


@dataclass(frozen=True, eq=False)
class ProcessRemainder:
    """ε_j(x) = Σ_i k(|x − x_i|/ℓ_j) w_ij over x = (sin q, cos q, v, a), where x is nearly known; else nothing.

    Torque that physics leaves at one state of the arm comes again at the same state, whatever its cause. The process
    says so and no more: where the training motion does not take away half of its variance, it is silent. With k the
    Matérn kernel of order 5/2 (Rasmussen and Williams 2006, eq. 4.17), r the noise over the variance, the share that
    is taken away is told as max_i k_i² Σ k_i²/(Σ k_i² + r): exact for samples at one place, along a line at most 0.15
    too much, and without a matrix of all samples in the file.

    Args:
        centre, spread: shape (n_inputs,), by which inputs are standardised.
        anchors: shape (m, n_inputs), standardised training samples.
        counted: shape (m, dof), the anchors at which a joint moved.
        weights: shape (m, dof) [N m]; 0 where an anchor does not count.
        length: shape (dof,), ℓ in standardised inputs.
        noise: shape (dof,), r.
        share: shape (dof,), 1 where the process is used.
    """

    centre: np.ndarray
    spread: np.ndarray
    anchors: np.ndarray
    counted: np.ndarray
    weights: np.ndarray
    length: JointVector
    noise: JointVector
    share: JointVector

    def torque(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """ε at samples that stand for themselves, shape (n, dof) [N m]."""
        out = np.zeros(np.shape(q))
        x = (process_inputs(q, v, a) - self.centre) / self.spread
        distance = np.sqrt(squared_distances(x, self.anchors))
        for joint in np.flatnonzero(self.share):
            counted = self.counted[:, joint]
            away = distance[:, counted] / self.length[joint]
            near = np.flatnonzero(matern(away.min(axis=1)) ** 2 > KNOWN)  # elsewhere no sum of them is known either
            k = matern(away[near])
            known = taken_away(k, self.noise[joint]) > KNOWN
            out[near, joint] = (k @ self.weights[counted, joint]) * known * self.share[joint]
        return out


def taken_away(k: np.ndarray, noise: float) -> np.ndarray:
    """Share of the process' variance that training samples take away, shape (n,).

    Args:
        k: shape (n, m), kernel between samples and training samples.
        noise: variance of the noise over that of the process.
    """
    squares = np.sum(k**2, axis=1)
    return np.max(k, axis=1, initial=0.0) ** 2 * squares / (squares + noise)


def process_inputs(q: Trajectory, v: Trajectory, a: Trajectory) -> np.ndarray:
    """What the process sees, shape (n, 4 dof)."""
    return np.hstack([angles(q), v, a])


def matern(distance: np.ndarray) -> np.ndarray:
    """k(d) = (1 + √5 d + 5 d²/3) exp(−√5 d)."""
    return (1.0 + FIVE * distance + 5.0 / 3.0 * distance**2) * np.exp(-FIVE * distance)
