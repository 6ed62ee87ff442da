"""All data checks over all recordings of a diagnosis, before any physics: corrected, refused or reported."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from lagnet.diagnosis.data_quality.check import BETTER, Evidence, Reading, fits_far_better
from lagnet.diagnosis.data_quality.checks import CHECKS
from lagnet.diagnosis.data_quality.effort import effort_findings
from lagnet.diagnosis.data_quality.physics import misfits_with_mounting_and_body
from lagnet.diagnosis.data_quality.samples import smoothed_stretches
from lagnet.errors import DiagnosisError
from lagnet.recordings.quality.finding import CERTAIN, Finding
from lagnet.recordings.quality.screen import Screened, refuse_harmful, screen
from lagnet.recordings.recording import Recording

SUSPECT = 0.5  # misfit of some joint, from which other readings are tested
SOUND = 0.005  # misfit of the arm, below which none is


@dataclass(frozen=True, eq=False)
class Inspected:
    """Recordings without excluded samples, and the findings."""

    recordings: tuple[Recording, ...]
    findings: tuple[Finding, ...]


def inspect_quality(recordings: Sequence[Recording], robot: Any = None) -> tuple[Finding, ...]:
    """Faults in the data of recordings, none of which is refused.

    Args:
        recordings: as read.
        robot: a torque model with `joints` and `inverse_dynamics`; None: only checks that need no model.
    """
    screened = [screen(recording, robot) for recording in recordings]
    found = [finding for one in screened for finding in one.findings]
    if robot is None or any(f.refused for f in found):
        return tuple(found)
    return (*found, *_readings([one.recording for one in screened], robot))


def screened_for(recordings: Sequence[Recording], robot: Any) -> Inspected:
    """The recordings without excluded samples, and the findings.

    Raises:
        RecordingError: data that a diagnosis would report as physics; which, where, and what corrects it.
    """
    screened: list[Screened] = [screen(recording, robot) for recording in recordings]
    found = [finding for one in screened for finding in one.findings]
    refuse_harmful(found)
    kept = tuple(one.recording for one in screened)
    read = _readings(kept, robot)
    refuse_harmful(read)
    return Inspected(kept, (*found, *read))


@contextmanager
def refused_with(findings: Sequence[Finding]) -> Iterator[None]:
    """Adds what the data seem to hold to the refusal of recordings in another convention.

    Raises:
        DiagnosisError: the one that was raised within, with the findings that a diagnosis would tell as physics.
    """
    try:
        yield
    except DiagnosisError as error:
        seen = "; ".join(f.detail for f in findings if f.harmful)
        if not seen:
            raise
        step = f"{error.next_step}; as the data look, {seen}"
        raise DiagnosisError(error.what, where=error.where, choices=error.choices, next_step=step) from error


def _readings(recordings: Sequence[Recording], robot: Any) -> tuple[Finding, ...]:
    """The reading under which the recordings fit the model, if they do not as they are and there is one.

    If there is none, what the effort column holds, if that is no joint torque.
    """
    series = smoothed_stretches(recordings)
    if not series:
        return ()
    with np.errstate(all="ignore"):
        evidence = Evidence(robot, series)
        suspect = not evidence.misfits.max() < SUSPECT and evidence.as_recorded > SOUND
        tried: list[Reading] = []
        for check in CHECKS:
            if check.always or (suspect and not (check.last and any(map(evidence.accepts, tried)))):
                tried.extend(check().readings(evidence))
        best = min(tried, key=lambda reading: (not reading.agreed, reading.misfit * reading.prior), default=None)
        if best is None or not _is_told(best, evidence):
            return effort_findings(recordings, robot, evidence) if suspect else ()
    return (_finding(best, [r for r in tried if evidence.accepts(r)]),)


def _is_told(reading: Reading, evidence: Evidence) -> bool:
    """Whether a reading is accepted, and explains what no other mounting and body would."""
    if not evidence.accepts(reading):
        return False
    return reading.agreed or fits_far_better(reading.misfits, misfits_with_mounting_and_body(evidence))


def _finding(best: Reading, accepted: Sequence[Reading]) -> Finding:
    rivals = () if best.agreed else [r for r in accepted if r.check != best.check]
    others = [r for r in rivals if r.misfit * r.prior < best.misfit * best.prior / BETTER]
    also = f"; or {' or '.join(r.detail for r in others[:1])}" if others else ""
    return Finding(best.check, "", best.channel, None, CERTAIN, best.detail + also, best.mend, harmful=True)
