"""What the effort column holds, asked where the model does not fit: told where no wrong model would look the same.

A wrong model changes factors between column and torque by a few times at most and can be mounted otherwise; only what
neither explains is told, never as certain, and nothing is changed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from lagnet.diagnosis.data_quality.check import BETTER, Evidence
from lagnet.diagnosis.data_quality.misfit import geometric_mean
from lagnet.diagnosis.data_quality.physics import misfits_with_mounting_and_body
from lagnet.diagnosis.effort_column.decide import effort_column
from lagnet.diagnosis.effort_column.finding import UNIT_IN_NEWTON_METRES, EffortFinding
from lagnet.errors import LagnetError
from lagnet.recordings.quality.finding import Finding
from lagnet.recordings.recording import Recording
from lagnet.types import knows_masses

RECORDINGS, LONGEST = 4, 20_000  # that are looked at, and samples of each
MOST = 1500  # samples that are compared
COPIES = ("position", "velocity", "position error")
OF_SIZE = ("current", "magnitude of current", "duty")  # told by the size of factors, as a wrong model may have them
FAR = 3.0  # times the model's torque, or a third of it: beyond, no wrong masses
FEWEST_JOINTS = 2  # that change: at a single joint friction, offset or spring look like anything


def effort_findings(recordings: Sequence[Recording], robot: Any, evidence: Evidence) -> tuple[Finding, ...]:
    """A finding where the column is no joint torque in N m; none where that cannot be told.

    Args:
        recordings: with a torque.
        robot: the nominal model.
        evidence: what the checks of readings saw of both.
    """
    if not hasattr(robot, "gravity_torque"):
        return ()
    try:
        found = effort_column([r.rows(slice(0, LONGEST)) for r in _few(recordings)], robot, most=MOST)
    except (LagnetError, np.linalg.LinAlgError):
        return ()
    if not _beyond_a_wrong_model(found, robot):
        return ()
    if found.kind not in COPIES:
        otherwise = float(geometric_mean(misfits_with_mounting_and_body(evidence)))
        if otherwise < BETTER * evidence.as_recorded:
            return ()
    told = found.data_quality("")
    return () if told is None else (replace(told, harmful=True),)


def _few(recordings: Sequence[Recording]) -> Sequence[Recording]:
    every = max(1, len(recordings) // RECORDINGS)
    return recordings[::every][:RECORDINGS]


def _beyond_a_wrong_model(found: EffortFinding, robot: Any) -> bool:
    if found.kind == "constant" or found.n_changing < FEWEST_JOINTS:
        return False  # a column that never changes is a dead channel, which has a check of its own
    by_size = found.kind in OF_SIZE
    if (by_size or found.unit in UNIT_IN_NEWTON_METRES) and not knows_masses(robot):
        return False  # the torque of placeholders has no size
    if not by_size:
        return True
    factors = np.abs([s for s in found.scale if s])
    return bool(factors.size) and abs(float(np.mean(np.log(factors)))) > np.log(FAR)
