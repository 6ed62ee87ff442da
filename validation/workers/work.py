"""Small and large recordings, and the work on them that workers are timed at."""

from __future__ import annotations

import resource
import time
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

import numpy as np

import lagnet
from lagnet.recordings.recording import Recording
from lagnet.recordings.writing import write_recording
from lagnet.rigid_body.random_arm import random_arm_urdf
from lagnet.tracking.manifest import Make, TrackedRecording, TrackSettings
from lagnet.tracking.tracked_set import set_from_plain
from lagnet.tracking.work import Calibration, Work, calibrate, diagnose_one
from validation.fleet.arms import urdf

RATE = 100.0  # [Hz]
NOISE, SHARP = 0.03, 0.01  # [N m], speed over which dry friction turns [rad/s]
FILES = 40  # recordings of a kind; tasks beyond that read them again, into folders of their own


@dataclass(frozen=True)
class Spent:
    """What a task took of its worker: wall and processor time [s], greatest resident memory so far [bytes]."""

    wall: float
    processor: float
    memory: int


def timed(task: Work) -> Spent:
    """Diagnoses, and tells what it took.

    Raises:
        RuntimeError: the diagnosis failed.
    """
    wall, processor = time.perf_counter(), time.process_time()
    told = diagnose_one(task)
    if "error" in told:
        raise RuntimeError(told["error"])
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    return Spent(time.perf_counter() - wall, time.process_time() - processor, memory)


def write_arm(folder: Path, joints: int) -> str:
    """The nominal model of the planar arm (two joints), or of an arm of as many."""
    path = folder / f"arm_{joints}.urdf"
    path.write_text(urdf("planar") if joints == 2 else random_arm_urdf(joints, seed=1, kinds=("revolute",)))
    return str(path)


def record(robot: lagnet.Robot, seconds: float, rng: np.random.Generator) -> Recording:
    """Sums of sines, with friction that falls from the base outwards."""
    time_ = np.arange(int(seconds * RATE)) / RATE
    omega = 2.0 * np.pi * rng.uniform(0.08, 0.8, (5, robot.n_dof))
    size = rng.uniform(0.12, 0.3, omega.shape) / np.sqrt(1.0 + (omega / 3.0) ** 2)
    angle = omega * time_[:, None, None] + rng.uniform(0.0, 2.0 * np.pi, omega.shape)
    q, v = (size * np.sin(angle)).sum(axis=1), (size * omega * np.cos(angle)).sum(axis=1)
    a = -(size * omega**2 * np.sin(angle)).sum(axis=1)
    friction = np.linspace(1.2, 0.5, robot.n_dof)
    tau = robot.inverse_dynamics(q, v, a) + friction * (v + np.tanh(v / SHARP))
    return Recording(time_, q, tau + NOISE * rng.standard_normal(tau.shape), robot.joints)


def tasks_of(folder: Path, joints: int, seconds: float, count: int, search: str) -> list[Work]:
    """Work on recordings of an arm, each with a folder of its own; their make is calibrated first."""
    rng, path = np.random.default_rng([joints, count]), write_arm(folder, joints)
    robot = lagnet.load_robot(path)
    files = [folder / f"{joints}_{k}.parquet" for k in range(min(count, FILES) + 1)]
    for file in files:
        write_recording(record(robot, seconds, rng), file)
    settings = TrackSettings(reports=False, search=search)
    make = Make(f"arm_{joints}", path)
    plain = calibrate(Calibration(make, (str(files[0]),), settings, folder / f"calibration_{joints}", (1.0,)))
    tracked = set_from_plain(plain["set"])
    return [
        Work(
            _one(files[1 + k % (len(files) - 1)], make), make, tracked, settings, folder / f"{search}_{joints}" / f"{k}"
        )
        for k in range(count)
    ]


def _one(file: Path, make: Make) -> TrackedRecording:
    return TrackedRecording("robot", make.name, str(file), datetime(2025, 1, 6))


def shares(tasks: Sequence[Work], parts: int) -> list[list[Work]]:
    """Tasks in so many equal parts."""
    size = len(tasks) // parts
    return [list(tasks[i * size : (i + 1) * size]) for i in range(parts)]
