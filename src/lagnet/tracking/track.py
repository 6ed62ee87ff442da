"""Follows the physics of a fleet: calibrate, diagnose every recording, tell what changed; resumable at any point."""

from __future__ import annotations

import hashlib
import os
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from lagnet.errors import LagnetError
from lagnet.tracking.engine import Engine, EngineSettings, open_engine
from lagnet.tracking.finished import read_finished, remove_parts
from lagnet.tracking.growth import NotFollowed, grown
from lagnet.tracking.manifest import Make, Manifest, TrackedRecording, read_manifest
from lagnet.tracking.servos.tracked import Followed, common_followed, followed_from_plain
from lagnet.tracking.statistics.analyse import Analysis, analyse
from lagnet.tracking.statistics.series import Observation
from lagnet.tracking.tables import TrackRow, write_tables
from lagnet.tracking.work import Calibration, Work, calibrate, diagnose_one, fingerprint_of, fit_one

Progress = Callable[[str, int, int], None]


@dataclass(frozen=True, eq=False)
class Track:
    """What `track` found.

    Args:
        manifest: what was tracked.
        rows: of track.parquet.
        analysis: changes, and where each robot stands.
        folder: what was written.
        joints: of each robot, in model order; of those with a diagnosis.
        not_followed: effects that searches named beyond what is followed.
    """

    manifest: Manifest
    rows: tuple[TrackRow, ...]
    analysis: Analysis
    folder: Path
    joints: Mapping[str, tuple[str, ...]]
    not_followed: tuple[NotFollowed, ...] = ()

    @property
    def failed(self) -> tuple[TrackRow, ...]:
        """Recordings without a diagnosis."""
        return tuple(r for r in self.rows if r.error is not None)


@dataclass(eq=False)
class _Desk:
    """Hands work out: what is finished is read, the rest goes through one engine that is opened when first needed."""

    settings: EngineSettings
    progress: Progress
    stack: ExitStack = field(default_factory=ExitStack)
    engine: Engine | None = None

    def done(self, title: str, work: Callable[[Any], dict], kind: str, tasks: Sequence[Any]) -> list[dict[str, Any]]:
        """What each task told, in order; `error` where it failed."""
        told: list[dict[str, Any]] = [read_finished(t.folder, fingerprint_of(kind, t)) or {} for t in tasks]
        open_ = [i for i, t in enumerate(told) if not t]
        self.progress(title, len(tasks) - len(open_), len(tasks))
        if not open_:
            return told
        if self.engine is None:
            self.engine = self.stack.enter_context(open_engine(self.settings))
        for count, outcome in enumerate(self.engine.run(work, [tasks[i] for i in open_]), 1):
            told[open_[outcome.index]] = outcome.result if outcome.error is None else {"error": outcome.error}
            self.progress(title, len(tasks) - len(open_) + count, len(tasks))
        return told


def track(
    manifest: str | Path,
    out: str | Path,
    engine: EngineSettings | None = None,
    progress: Progress = lambda title, done, total: None,
) -> Track:
    """Diagnoses every recording of a fleet and tells which parameters changed when.

    Args:
        manifest: see `lagnet.tracking.manifest`.
        out: folder for calibrations, diagnoses and tables; what an earlier run finished there is kept.
        engine: where the work is done; processes of this machine by default.
        progress: is told the step, and how much of it is done, of how much.

    Raises:
        LagnetError: the manifest is wrong, a calibration cannot be made, or there is no scheduler at the address.
    """
    fleet, folder = read_manifest(manifest), Path(out).resolve()
    base = Path(manifest).resolve().parent
    folder.mkdir(parents=True, exist_ok=True)
    remove_parts(folder)
    desk = _Desk(engine or EngineSettings(), progress)
    with desk.stack:
        sets = _sets(fleet, folder, desk)
        tasks = [_task(r, fleet, sets[r.make], folder, "diagnoses") for r in fleet.recordings]
        told = desk.done("diagnoses", diagnose_one, "diagnosis", tasks)
        told, left_out = grown(tasks, told, folder, lambda title, work: desk.done(title, fit_one, "fit", work))
    observations = [o for r, t in zip(fleet.recordings, told, strict=True) for o in _observations(r, t)]
    analysis = analyse(observations, fleet.settings.false_discovery_rate, fleet.settings.temperature_sigma)
    rows = tuple(_rows(tasks, told, analysis, base, folder))
    write_tables(rows, analysis, left_out, folder)
    joints = {r.robot: tuple(t["joints"]) for r, t in zip(fleet.recordings, told, strict=True) if "joints" in t}
    return Track(fleet, rows, analysis, folder, joints, tuple(left_out))


def _task(recording: TrackedRecording, fleet: Manifest, tracked: Followed, out: Path, room: str) -> Work:
    key = f"{recording.date:%Y-%m-%dT%H%M%S}_{hashlib.sha256(recording.file.encode()).hexdigest()[:8]}"
    make = fleet.makes[recording.make]
    return Work(recording, make, tracked, fleet.settings, out / room / recording.robot / key)


def _sets(fleet: Manifest, out: Path, desk: _Desk) -> dict[str, Followed]:
    """What is followed on each make: of its calibration, or of the first recording of each of its robots."""
    tasks: list[Calibration] = []
    gain_of = {r.file: r.gain for r in fleet.recordings}
    for make in _used(fleet):
        room = out / "calibration" / make.name
        if make.calibration:
            gains = tuple(gain_of.get(file, 1.0) for file in make.calibration)
            tasks.append(Calibration(make, make.calibration, fleet.settings, room, gains))
            continue
        first = {r.robot: r for r in reversed(fleet.recordings) if r.make == make.name}
        tasks += [
            Calibration(make, (one.file,), fleet.settings, room / name, (one.gain,))
            for name, one in sorted(first.items())
        ]
    told = desk.done("calibration", calibrate, "calibration", tasks)
    sets: dict[str, list[Followed]] = defaultdict(list)
    errors: dict[str, str] = {}
    for task, result in zip(tasks, told, strict=True):
        if "set" in result:
            sets[task.make.name].append(followed_from_plain(result["set"]))
        else:
            errors.setdefault(task.make.name, str(result["error"]))
    for make in _used(fleet):
        if not sets[make.name]:
            step = "mend the recording, or state other calibration recordings"
            raise LagnetError(f"no calibration ({errors[make.name]})", where=f"make {make.name}", next_step=step)
    return {
        name: found[0] if fleet.makes[name].calibration else common_followed(found, name)
        for name, found in sets.items()
    }


def _used(fleet: Manifest) -> list[Make]:
    return [fleet.makes[name] for name in sorted({r.make for r in fleet.recordings})]


def _observations(recording: TrackedRecording, told: dict[str, Any]) -> Iterable[Observation]:
    for row in told.get("rows", ()):
        yield Observation(
            recording.robot, recording.make, date=recording.date, recording=recording.file, **row, **_at(row, told)
        )


def _at(row: dict[str, Any], told: dict[str, Any]) -> dict[str, Any]:
    """Temperature and load that go with a parameter."""
    warm, joint = told["temperature"], row["joint"]
    if joint is not None:
        at = told["joints"].index(joint)
        return {"temperature": warm[at], "load": told["load"][at]}
    return {"temperature": float(np.mean(warm)) if None not in warm else None, "load": None}


def _rows(
    tasks: Sequence[Work], told: Sequence[dict[str, Any]], analysis: Analysis, base: Path, out: Path
) -> Iterable[TrackRow]:
    adjusted = {
        (a.observation.recording, a.observation.effect, a.observation.joint, a.observation.parameter): a
        for a in analysis.adjusted
    }
    for task, result in zip(tasks, told, strict=True):
        one = task.recording
        told_of = {"robot": one.robot, "make": one.make, "date": one.date, "recording": _seen_from(base, one.file)}
        if "error" in result:
            yield TrackRow(**told_of, error=str(result["error"]))
            continue
        if result.get("searched", True):
            told_of["diagnosis"] = task.folder.relative_to(out).as_posix()
        if not result["rows"]:
            yield TrackRow(**told_of)
        for row in result["rows"]:
            at = adjusted.get((one.file, row["effect"], row["joint"], row["parameter"]))
            extra = {} if at is None else {"adjusted": at.value, "outlier": at.outlier}
            yield TrackRow(**told_of, **row, **_at(row, result), **extra)


def _seen_from(base: Path, file: str) -> str:
    return os.path.relpath(file, base) if file.startswith(f"{base}{os.sep}") else file
