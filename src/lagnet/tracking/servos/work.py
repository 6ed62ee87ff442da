"""What workers do with recordings of commands and no torque: calibrate the servos of a make, fit them, search anew."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from lagnet.diagnosis.motion.diagnose import MotionDiagnosis, diagnose_motion
from lagnet.diagnosis.motion.problem import is_a_servo_recording
from lagnet.diagnosis.motion.writing import write_motion_diagnosis
from lagnet.errors import LagnetError
from lagnet.recordings.recording import Recording
from lagnet.reports.motion_report import write_motion_report
from lagnet.servos.nominal import NominalServo
from lagnet.servos.servo_file import read_servo_file
from lagnet.tracking.manifest import Make, TrackSettings
from lagnet.tracking.servos.fit import fit_servos
from lagnet.tracking.servos.tracked import TrackedServos, servos_of_calibration


def on_motion(recordings: Sequence[Recording]) -> bool:
    """Whether recordings hold commands and no torque.

    Raises:
        LagnetError: some do, some do not.
    """
    kinds = [is_a_servo_recording(r) for r in recordings]
    if any(kinds) and not all(kinds):
        where = recordings[kinds.index(False)].path or None
        step = "calibrate with recordings of one kind, all with torque or all with commands alone"
        raise LagnetError("holds torque, where other recordings of its make do not", where=where, next_step=step)
    return all(kinds)


def calibrated_servos(
    recordings: Sequence[Recording], nominal: Any, make: Make, gains: Sequence[float], seed: int
) -> tuple[MotionDiagnosis, TrackedServos]:
    """The diagnosis of healthy recordings on motion, and what is followed of it."""
    found = diagnose_motion(recordings, nominal, servo=_servo(make, nominal), gains=gains, seed=seed)
    tracked = servos_of_calibration(found)
    left = [fit_servos(r, nominal, tracked, g).left for r, g in zip(recordings, gains, strict=True)]
    return found, replace(tracked, left=tuple(map(float, np.median(left, axis=0))))


def servos_fitted(recording: Recording, nominal: Any, tracked: TrackedServos, gain: float) -> dict[str, Any]:
    """The set fitted to a recording, as plain values; see `work.diagnose_one`."""
    fit = fit_servos(recording, nominal, tracked, gain)
    return {
        "joints": list(recording.joints),
        "rows": [asdict(row) for row in fit.rows],
        "effects": [],
        "load": [float(x) for x in fit.load],
        "left": [float(x) for x in fit.left],
        "determined": [asdict(d) for d in fit.determined],
    }


def servos_searched(recording: Recording, nominal: Any, make: Make, gain: float, seed: int) -> MotionDiagnosis:
    """A diagnosis of one recording against the nominal servos."""
    return diagnose_motion([recording], nominal, servo=_servo(make, nominal), gains=[gain], seed=seed)


def fill_with_motion(result: MotionDiagnosis, folder: Path, settings: TrackSettings) -> None:
    """Writes a diagnosis into its folder."""
    write_motion_diagnosis(result, folder)
    if settings.reports:
        write_motion_report(result, folder / "report.html")


def _servo(make: Make, nominal: Any) -> NominalServo | None:
    return None if make.actuator is None else read_servo_file(make.actuator, nominal.joints, nominal.armature)
