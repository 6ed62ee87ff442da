"""The pieces of work that workers do: calibrate a make, diagnose a recording, fit a larger set to it.

Every function takes one picklable value and writes one folder, whole or not at all; called again with the same inputs,
it reads what is there.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from lagnet._version import __version__
from lagnet.diagnosis.diagnose import Diagnosis, diagnose
from lagnet.diagnosis.writing import write_diagnosis
from lagnet.errors import LagnetError
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.models.files.loading import load_any
from lagnet.recordings.loading.load import load_recording
from lagnet.recordings.recording import Recording
from lagnet.reports.diagnosis_report import write_report
from lagnet.tracking.files import local_copy, stamp
from lagnet.tracking.finished import fingerprint, read_finished, write_finished
from lagnet.tracking.fixed_fit import fit_set, model_with
from lagnet.tracking.manifest import Make, TrackedRecording, TrackSettings
from lagnet.tracking.servos.new_physics import named_beyond
from lagnet.tracking.servos.tracked import Followed, TrackedServos
from lagnet.tracking.servos.work import calibrated_servos, fill_with_motion, on_motion, servos_fitted, servos_searched
from lagnet.tracking.temperature import joint_temperature
from lagnet.tracking.tracked_set import TrackedSet, beyond, effect_from_plain, lasting, set_of_calibration


@dataclass(frozen=True)
class Calibration:
    """Recordings of a make, diagnosed together against its nominal model, with the controller's gain in each."""

    make: Make
    files: tuple[str, ...]
    settings: TrackSettings
    folder: Path
    gains: tuple[float, ...]


@dataclass(frozen=True)
class Work:
    """One recording to diagnose with the set of its make, into a folder."""

    recording: TrackedRecording
    make: Make
    tracked: Followed
    settings: TrackSettings
    folder: Path


def calibrate(task: Calibration) -> dict[str, Any]:
    """Names the physics of healthy recordings.

    Returns:
        `set`: the plain form of the tracked set, or `error`.
    """
    made_from = fingerprint_of("calibration", task)
    known = read_finished(task.folder, made_from)
    if known is not None:
        return known
    try:
        nominal = _nominal(task.make)
        recordings = [_read(f, task.make, nominal)[0] for f in task.files]
        if on_motion(recordings):
            found, servos = calibrated_servos(recordings, nominal, task.make, task.gains, task.settings.seed)
            told = {"set": servos.plain()}
            return write_finished(
                task.folder, made_from, told, lambda folder: fill_with_motion(found, folder, task.settings)
            )
        result = diagnose(recordings, nominal, bandwidth=task.settings.bandwidth, seed=task.settings.seed)
        tracked = set_of_calibration(result.corrected, result.verdict.conditioning["bandwidth_hz"])
        left = np.median([fit_set(r, nominal, tracked).left for r in recordings], axis=0)
    except LagnetError as error:
        return write_finished(task.folder, made_from, {"error": str(error)}, lambda folder: None)
    tracked = replace(tracked, left=tuple(map(float, left)))
    return write_finished(
        task.folder, made_from, {"set": tracked.plain()}, lambda folder: _fill(result, folder, task.settings)
    )


def diagnose_one(task: Work) -> dict[str, Any]:
    """Fits the set to the recording, and diagnoses it against the model with the fitted set.

    Where that model still lacks something, the parameters of the set have taken up part of it, and would mislead the
    search: the recording is then diagnosed against the model before the fit, so that all is found together.

    Returns:
        `rows`: parameters of the set; `searched`: False where the set explains all as usual and nothing else was looked
        for, absent else; `new`: effects beyond it; `load`, `left`, `temperature`: for each joint; `joints`;
        or `error` alone.
    """
    made_from = fingerprint_of("diagnosis", task)
    known = read_finished(task.folder, made_from)
    if known is not None:
        return known
    settings = task.settings
    try:
        nominal = _nominal(task.make)
        recording, temperature = _read(task.recording.file, task.make, nominal, task.recording.temperature)
        told = _fitted(recording, nominal, task) | {"temperature": temperature}
        if settings.search == "unusual" and not task.tracked.is_unusual(np.array(told["left"])):
            return write_finished(task.folder, made_from, told | {"new": [], "searched": False}, lambda folder: None)
        if isinstance(task.tracked, TrackedServos):
            found = servos_searched(recording, nominal, task.make, task.recording.gain, settings.seed)
            told["new"] = [asdict(e) for e in named_beyond(task.tracked, found)]
            return write_finished(
                task.folder, made_from, told, lambda folder: fill_with_motion(found, folder, settings)
            )
        result = _searched(recording, nominal, task.tracked, settings.seed, told)
    except LagnetError as error:
        return write_finished(task.folder, made_from, {"error": str(error)}, lambda folder: None)
    told["new"] = [_plain(e) for e in beyond(task.tracked, lasting(result.corrected.effects))]
    return write_finished(task.folder, made_from, told, lambda folder: _fill(result, folder, settings))


def _searched(recording: Recording, nominal: Any, tracked: TrackedSet, seed: int, told: Mapping[str, Any]) -> Diagnosis:
    known = {"bandwidth": tracked.bandwidth, "seed": seed}
    if not tracked.is_unusual(np.array(told["left"])):
        fitted = [effect_from_plain(e) for e in told["effects"]]
        result = diagnose([recording], model_with(nominal, (*tracked.held, *fitted), tracked), **known)
        if not lasting(result.corrected.effects):
            return result
    return diagnose([recording], model_with(nominal, tracked.held, tracked) if tracked.held else nominal, **known)


def fit_one(task: Work) -> dict[str, Any]:
    """Fits a set alone, for robots on which more is followed than on their make; see `diagnose_one`."""
    made_from = fingerprint_of("fit", task)
    known = read_finished(task.folder, made_from)
    if known is not None:
        return known
    try:
        nominal = _nominal(task.make)
        recording, temperature = _read(task.recording.file, task.make, nominal, task.recording.temperature)
        told = _fitted(recording, nominal, task) | {"temperature": temperature}
    except LagnetError as error:
        told = {"error": str(error)}
    return write_finished(task.folder, made_from, told, lambda folder: None)


def fingerprint_of(kind: str, task: Calibration | Work) -> str:
    """Checksum of the inputs of `calibrate` ("calibration"), `diagnose_one` ("diagnosis") or `fit_one` ("fit")."""
    if isinstance(task, Calibration):
        files: Any = [(f, stamp(f)) for f in task.files]
        return fingerprint(kind, __version__, _of_make(task.make), files, task.gains, _of(task.settings))
    one = task.recording
    file = (one.file, stamp(one.file), one.temperature, one.gain)
    return fingerprint(kind, __version__, _of_make(task.make), file, task.tracked.plain(), _of(task.settings))


def _of_make(make: Make) -> Any:
    return (
        make.robot,
        stamp(make.robot),
        make.columns,
        make.columns and stamp(make.columns),
        make.torque_constant,
        dict(make.hold),
        make.actuator and stamp(make.actuator),
    )


def _of(settings: TrackSettings) -> Any:
    return settings.bandwidth, settings.seed, settings.reports, settings.search


def _nominal(make: Make) -> Any:
    return load_any(make.robot, dict(make.hold)) if make.hold else load_any(make.robot)


def _read(
    file: str, make: Make, nominal: Any, temperature: float | None = None
) -> tuple[Recording, list[float | None]]:
    with local_copy(file) as path:
        recording = load_recording(path, robot=nominal, columns=make.columns, torque_constant=make.torque_constant)
        return recording, joint_temperature(recording, path, temperature)


def _fitted(recording: Recording, nominal: Any, task: Work) -> dict[str, Any]:
    if isinstance(task.tracked, TrackedServos):
        return servos_fitted(recording, nominal, task.tracked, task.recording.gain)
    fit = fit_set(recording, nominal, task.tracked)
    return {
        "joints": list(recording.joints),
        "rows": [asdict(row) for row in fit.rows],
        "effects": [_plain(e) for e in fit.effects],
        "load": [float(x) for x in fit.load],
        "left": [float(x) for x in fit.left],
    }


def _plain(effect: NamedEffect) -> dict[str, Any]:
    return {"effect": effect.effect, "joint": effect.joint, "values": {k: float(v) for k, v in effect.values.items()}}


def _fill(result: Diagnosis, folder: Path, settings: TrackSettings) -> None:
    write_diagnosis(result, folder)
    if settings.reports:
        write_report(result.verdict.to_dict(), result.evidence, folder / "report.html")
