"""Torque of a model at every sample of a recording as given, and along its conditioned motion."""

from __future__ import annotations

import numpy as np

from lagnet.models.corrected.model import torque_along
from lagnet.recordings.conditioning.condition import Conditioned
from lagnet.recordings.conditioning.smoothing import resample
from lagnet.recordings.recording import Recording
from lagnet.types import InverseDynamics


def torque_at_samples(model: InverseDynamics, recording: Recording, conditioned: Conditioned, index: int) -> np.ndarray:
    """Modelled torque at every sample of the recording, shape (n, dof) [N m]: nothing filtered away, nothing cut.

    Samples in runs too short to be differentiated are taken as standing still. Where stamps of torque and motion were
    found to be apart, the torque is that of the time at which the recorded one was taken.

    Args:
        index: which of the conditioned recordings it is.
    """
    torque = np.full(recording.q.shape, np.nan)
    for stretch in conditioned.stretches:
        if stretch.recording == index:
            along = torque_along(model, stretch.time, stretch.q, stretch.v, stretch.a)
            rows = slice(stretch.first, stretch.last + 1)
            torque[rows] = resample(stretch.time, along, recording.time[rows] - conditioned.torque_shift)
    lost = np.isnan(torque).any(axis=1)
    if lost.any():
        rest = np.zeros((int(lost.sum()), recording.n_dof))
        torque[lost] = model.inverse_dynamics(recording.q[lost], rest, rest)
    return torque
