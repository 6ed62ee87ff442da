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


@dataclass(frozen=True, eq=False)
class HoldoutErrors:
    """Errors on held-out recordings below the bandwidth, by layer.

    Args:
        powers: shape (dof,), mean square error of each layer [(N m)²].
        variance: shape (dof,), of the measured torque [(N m)²].
    """

    powers: dict[str, np.ndarray]
    variance: np.ndarray

    @property
    def nmse(self) -> dict[str, np.ndarray]:
        """Power of the error over the variance of the torque, shape (dof,) by layer."""
        return {kind: power / self.variance for kind, power in self.powers.items()}

    def beyond(self, noise: np.ndarray) -> dict[str, np.ndarray]:
        """√max(mean r² − σ², 0) of each layer of the correction, shape (dof,); `noise` is σ, shape (dof,) [N m]."""
        kinds = {"named": "named", "identified": "identified", "full": "corrected"}
        return {layer: np.sqrt(np.maximum(self.powers[kind] - noise**2, 0.0)) for layer, kind in kinds.items()}


def holdout_errors(torques: Sequence[HoldoutTorque], conditioned: Conditioned) -> HoldoutErrors:
    """Errors of each layer, as modelled, against held-out torque."""
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
    powers = {kind: np.mean(np.concatenate(parts) ** 2, axis=0) for kind, parts in errors.items()}
    return HoldoutErrors(powers, variance)


def _filtered(x: np.ndarray, torque: HoldoutTorque, rows: slice, conditioned: Conditioned) -> np.ndarray:
    """Low-passed on an even clock, without the ends at which the filter settles."""
    valid = torque.recording.valid
    used = np.ones(len(x), dtype=bool) if valid is None else np.asarray(valid)[rows]  # bad data is no error of a model
    time, rate, bandwidth = torque.recording.time[rows][used], conditioned.rate, conditioned.bandwidth
    smooth = low_pass(resample(time, x[used], even_clock(time, rate)), rate, bandwidth)
    settle = int(np.ceil(SETTLING * rate / bandwidth))
    return smooth[settle:-settle] if len(smooth) > 2 * settle + SHORTEST else smooth
