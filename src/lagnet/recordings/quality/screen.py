"""All checks of data over one recording: what was found, and the recording less the samples that are set aside."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from lagnet.errors import RecordingError
from lagnet.recordings.quality.check import JointLimits, QualityCheck, Subject, no_limits
from lagnet.recordings.quality.checks import CHECKS
from lagnet.recordings.quality.finding import Finding
from lagnet.recordings.recording import Recording

FEWEST = 20  # samples that must be left


@dataclass(frozen=True, eq=False)
class Screened:
    """A recording after the checks.

    Args:
        recording: with the samples that are set aside marked in `valid`, at the times at which they were measured.
        findings: what was found, in the order of the checks.
    """

    recording: Recording
    findings: tuple[Finding, ...]


def limits_of(robot: Any, n_dof: int) -> JointLimits:
    """The limits of speed and effort and the prismatic joints that a model states; none where it states none."""
    blank = no_limits(n_dof)
    speed, effort = getattr(robot, "velocity_limit", None), getattr(robot, "effort_limit", None)
    types = getattr(robot, "joint_types", None)
    return JointLimits(
        blank.velocity if speed is None else np.asarray(speed, float),
        blank.effort if effort is None else np.asarray(effort, float),
        None if types is None else np.array([kind == "prismatic" for kind in types]),
    )


def screen(recording: Recording, robot: Any = None, checks: Sequence[type[QualityCheck]] = CHECKS) -> Screened:
    """Runs the checks in their order.

    Args:
        recording: as read.
        robot: anything with `velocity_limit`, `effort_limit` and `joint_types`; None where there is none.
    """
    limits = limits_of(robot, recording.n_dof)
    findings: list[Finding] = []
    for check in checks:
        found = tuple(check().find(Subject(recording, limits)))
        findings.extend(found)
        aside = np.concatenate([f.rows for f in found]) if found else np.zeros(0, dtype=np.int64)
        if aside.size:
            recording = _without(recording, np.unique(aside))
        for time in (f.time for f in found if f.time is not None):
            recording = replace(recording, time=time)
    return Screened(recording, tuple(findings))


def refuse_harmful(findings: Sequence[Finding]) -> None:
    """Refuses recordings that would tell a fault of the data as physics.

    Raises:
        RecordingError: the first such fault, and what mends it.
    """
    for finding in findings:
        if finding.refused:
            more = sum(f.refused for f in findings) - 1
            also = f" (and {more} more such fault{'s' * (more > 1)})" if more else ""
            raise RecordingError(finding.detail + also, where=finding.recording or None, next_step=finding.mend)


def _without(recording: Recording, rows: np.ndarray) -> Recording:
    valid = np.ones(len(recording), dtype=bool) if recording.valid is None else recording.valid.copy()
    valid[rows] = False
    if valid.sum() < FEWEST:
        return recording
    return replace(recording, valid=valid)
