"""The correction in its layers: named physics, what else the recordings determine, and what each leaves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.holdout_torque import HoldoutTorque, holdout_errors, holdout_torques
from lagnet.diagnosis.identified.fit import Identified
from lagnet.diagnosis.identified.remainder import learn_remainder
from lagnet.diagnosis.state import DiagnosisState
from lagnet.models.corrected.model import CorrectedModel
from lagnet.recordings.recording import Recording


@dataclass(frozen=True, eq=False)
class Correction:
    """What a diagnosis makes of the nominal model.

    Args:
        model: all layers.
        identified: the identified layer with its equations; None where there is nothing to identify.
        torques: torque of each layer at every held-out sample.
        errors: nMSE (dof,) of each layer on them.
    """

    model: CorrectedModel
    identified: Identified | None
    torques: tuple[HoldoutTorque, ...]
    errors: dict[str, np.ndarray]


def correct(state: DiagnosisState, held: Sequence[Recording], ends_of: Sequence[int | None]) -> Correction:
    """Estimates the layers beyond the named one, on fitted recordings alone, and judges all on held-out ones."""
    found = state.identified
    model = state.corrected if found is None else replace(state.corrected, identified=found.layer)
    remains = found is not None or any(size.above for size in state.sizes)
    learned = learn_remainder(state.problem, model, state.seed) if remains else None
    model = replace(model, remainder=learned)
    torques = holdout_torques(model, held, state.holdout, ends_of)
    return Correction(model, found, torques, holdout_errors(torques, state.holdout))
