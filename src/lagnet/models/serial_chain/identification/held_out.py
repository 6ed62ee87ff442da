"""Samples kept from fitting a serial chain, and what an arm leaves of their torque."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.models.serial_chain.identification.refit import Refitted
from lagnet.models.serial_chain.identification.unknowns import Unknowns

WORSE = 1.05  # times what the freer model leaves: no more than chance makes of the same arm
ROUNDING = 1e-13  # share of the torque that counts as nothing


@dataclass(frozen=True)
class Data:
    """Samples for fitting and for choosing.

    Args:
        train, holdout: q, v, a, tau, each of shape (n, dof).
    """

    train: tuple[np.ndarray, ...]
    holdout: tuple[np.ndarray, ...]


def split_samples(motion: tuple[np.ndarray, ...], share: float, rng: np.random.Generator) -> Data:
    """The samples in random order, a share of them held out; they carry no order in time here."""
    order = rng.permutation(motion[0].shape[0])
    kept = max(int(share * order.size), 1)
    return Data(tuple(part[order[kept:]] for part in motion), tuple(part[order[:kept]] for part in motion))


def residual(unknowns: Unknowns, motion: tuple[np.ndarray, ...], found: Refitted) -> np.ndarray:
    """Torque that an arm leaves, shape (n, dof) [N m]."""
    return motion[3] - np.asarray(unknowns.torque(found.x, found.w, *motion[:3]))


def held_out_share(unknowns: Unknowns, data: Data, found: Refitted) -> np.ndarray:
    """Residual over variance of held-out torque, shape (dof,)."""
    left = residual(unknowns, data.holdout, found)
    return np.mean(left**2, axis=0) / sizes(data.holdout[3]) ** 2


def as_good(simple: np.ndarray, free: np.ndarray, nothing: float = ROUNDING) -> bool:
    """Whether the simpler of two arms leaves no more than the freer one, by their held-out shares.

    Args:
        simple, free: shape (dof,), held-out shares of the two.
        nothing: share of the torque that counts as none.
    """
    return bool(np.all(simple <= WORSE * free + nothing))


def sizes(tau: np.ndarray) -> np.ndarray:
    """Spread of each joint's torque, shape (dof,) [N m]; of the largest where a joint has none."""
    size = tau.std(axis=0)
    return np.where(size > 1e-12 * max(size.max(), 1e-300), size, max(size.max(), 1.0))
