"""The correction in its layers: named physics, what else the recordings determine, and what each leaves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.holdout_torque import HoldoutTorque, holdout_errors, holdout_torques
from lagnet.diagnosis.identified.fit import Identified
from lagnet.diagnosis.identified.instead import instead_of_names, kept_among
from lagnet.diagnosis.identified.remainder.learn import learn_remainder
from lagnet.diagnosis.problem.intervals import lasting
from lagnet.diagnosis.state import DiagnosisState
from lagnet.models.corrected.identified import IdentifiedLayer
from lagnet.models.corrected.model import CorrectedModel
from lagnet.recordings.recording import Recording


@dataclass(frozen=True, eq=False)
class Correction:
    """What a diagnosis makes of the nominal model.

    Args:
        model: all layers.
        identified: the layer that torques are of, with its equations; None where there is nothing to identify.
        torques: torque of each layer at every held-out sample.
        errors: nMSE (dof,) of each layer on them.
    """

    model: CorrectedModel
    identified: Identified | None
    torques: tuple[HoldoutTorque, ...]
    errors: dict[str, np.ndarray]


def correct(state: DiagnosisState, held: Sequence[Recording], ends_of: Sequence[int | None]) -> Correction:
    """Estimates the layers beyond the named one, on fitted recordings alone, and judges all on held-out ones."""
    beside, remains = state.identified, any(size.above for size in state.sizes)
    significant = state.problem.limits.above_noise * state.sensor_noise
    instead = learned = None
    if beside is not None or remains:
        samples = state.equations.samples / state.selection.scales.inefficiency
        instead = instead_of_names(lasting(state.problem, state.events), state.effects, beside, significant, samples)
    names = kept_among(state.effects) if instead is None else instead.kept
    kept = frozenset((e.effect, e.joint) for e in names if e.always_acts)
    found = beside if instead is None else instead.found
    in_place = None if instead is None else instead.found.layer
    model = replace(state.corrected, identified=_layer_of(beside), instead=in_place, kept=kept)
    if found is not None or remains:
        learned = learn_remainder(state.problem, model, state.seed, floor=significant)
    model = replace(model, remainder=learned)
    torques = holdout_torques(model, held, state.holdout, ends_of)
    errors = holdout_errors(torques, state.holdout)
    return Correction(replace(model, errors=errors.beyond(state.sensor_noise)), found, torques, errors.nmse)


def _layer_of(found: Identified | None) -> IdentifiedLayer | None:
    return None if found is None else found.layer
