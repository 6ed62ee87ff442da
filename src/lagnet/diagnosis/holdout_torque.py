"""Torque of each layer of the correction at every held-out sample, and its error at one bandwidth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.prediction import torque_at_samples
from lagnet.models.corrected.model import CorrectedModel
from lagnet.recordings.conditioning.condition import Conditioned
from lagnet.recordings.conditioning.smoothing import SETTLING, SHORTEST, even_clock, low_pass, resample
from lagnet.recordings.recording import Recording

KINDS = ("nominal", "named", "identified", "corrected")


@dataclass(frozen=True, eq=False)
class HoldoutTorque:
    """Modelled torque of one held-out recording, by layer: each of shape (n, dof), every sample as given [N m]."""

    recording: Recording
    layers: dict[str, np.ndarray]


def holdout_torques(
    corrected: CorrectedModel, held: Sequence[Recording], conditioned: Conditioned, ends_of: Sequence[int | None]
) -> tuple[HoldoutTorque, ...]:
    """Torque of the nominal model, of the named, the identified and all layers on each held-out recording."""
    out = []
    for index, recording in enumerate(held):
        model = replace(corrected, recording=ends_of[index])
        nominal = torque_at_samples(corrected.nominal, recording, conditioned, index)
        full = torque_at_samples(model, recording, conditioned, index)
        named = torque_at_samples(model.with_layers("named"), recording, conditioned, index)
        parts = {"nominal": nominal, "named": named, "identified": full, "corrected": full}
        if model.with_layers("identified") is not model:
            parts["identified"] = torque_at_samples(model.with_layers("identified"), recording, conditioned, index)
        out.append(HoldoutTorque(recording, parts))
    return tuple(out)


def holdout_errors(torques: Sequence[HoldoutTorque], conditioned: Conditioned) -> dict[str, np.ndarray]:
    """nMSE of each layer and joint below the bandwidth: power of the error over the variance of the torque, (dof,)."""
    errors: dict[str, list[np.ndarray]] = {kind: [] for kind in KINDS}
    measured = []
    for index, torque in enumerate(torques):
        for stretch in conditioned.stretches:
            if stretch.recording != index:
                continue
            rows = slice(stretch.first, stretch.last + 1)
            measured.append(_filtered(torque.recording.torque[rows], torque, rows, conditioned))
            for kind in KINDS:
                error = torque.recording.torque[rows] - torque.layers[kind][rows]
                errors[kind].append(_filtered(error, torque, rows, conditioned))
    variance = np.maximum(np.concatenate(measured).var(axis=0), 1e-300)
    return {kind: np.mean(np.concatenate(parts) ** 2, axis=0) / variance for kind, parts in errors.items()}


def _filtered(x: np.ndarray, torque: HoldoutTorque, rows: slice, conditioned: Conditioned) -> np.ndarray:
    """Low-passed on an even clock, without the ends at which the filter settles."""
    valid = torque.recording.valid
    used = np.ones(len(x), dtype=bool) if valid is None else np.asarray(valid)[rows]  # bad data is no error of a model
    time, rate, bandwidth = torque.recording.time[rows][used], conditioned.rate, conditioned.bandwidth
    smooth = low_pass(resample(time, x[used], even_clock(time, rate)), rate, bandwidth)
    settle = int(np.ceil(SETTLING * rate / bandwidth))
    return smooth[settle:-settle] if len(smooth) > 2 * settle + SHORTEST else smooth
