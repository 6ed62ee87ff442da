"""A diagnosis up to its names: the layers below them and the curves of a report hang on names, and no name on them."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from lagnet.diagnosis.holdout_torque import holdout_errors, holdout_torques
from lagnet.diagnosis.layers import Correction
from lagnet.diagnosis.state import DiagnosisState
from lagnet.recordings.recording import Recording
from validation.ablations import neutral
from validation.ablations.taken_out import Instead


def _named_layer(old: Callable) -> Callable:
    """The correction by named physics alone, with its held-out errors."""

    def correct(state: DiagnosisState, held: Sequence[Recording], ends_of: Sequence[int | None]) -> Correction:
        torques = holdout_torques(state.corrected, held, state.holdout, ends_of)
        return Correction(state.corrected, None, torques, holdout_errors(torques, state.holdout).nmse)

    return correct


NAMES_ALONE: Instead = {
    "lagnet.diagnosis.layers:correct": _named_layer,
    "lagnet.diagnosis.verdict.collect_report_data:collect_report_data": neutral.value(None),
}
"""Stands in every run of the study, that of the whole diagnosis too."""
