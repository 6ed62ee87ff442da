"""Recordings of a planned robot: bodies by Pinocchio, friction by a law of its own, sensors with noise. NumPy alone."""

from __future__ import annotations

import csv
import hashlib
import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np

import lagnet
from lagnet.recordings.recording import Recording
from lagnet.recordings.writing import write_recording
from validation.fleet.arms import MAKES, urdf
from validation.fleet.draw import REFERENCE, PlannedRobot, draw_fleet

RATE, SECONDS = 100.0, 15.0
SHARP = 0.01  # speed over which dry friction turns [rad/s]
LOADED = 0.02  # of the magnitude of the bodies' torque that adds to dry friction
TORQUE_NOISE, ANGLE_NOISE = 0.03, 2e-5  # [N m], [rad]
THERMOMETER = 0.3  # [K]
WAVES = 5


def write_fleet(folder: Path, n_robots: int, n_recordings: int, seed: int, search: str) -> Path:
    """Writes nominal models, calibration recordings, all recordings with an index, a manifest, and the envelope.

    Returns:
        The manifest.
    """
    folder.mkdir(parents=True, exist_ok=True)
    rng = np.random.default_rng([seed, 1])
    fleet = draw_fleet(n_robots, n_recordings, seed)
    manifest = ['index = "recordings.csv"', "[settings]", "reports = false", f'search = "{search}"']
    for make in MAKES:
        (folder / f"{make}.urdf").write_text(urdf(make))
        first = next(r for r in fleet if r.make == make and r.fate.kind in ("steady", "warm"))
        for k in range(2):
            write_recording(record(first, 0, rng, folder)[0], folder / "calibration" / f"{make}_{k}.parquet")
        manifest += [
            "[[make]]",
            f'name = "{make}"',
            f'robot = "{make}.urdf"',
            f'calibration = "calibration/{make}_*.parquet"',
        ]
    (folder / "fleet.toml").write_text("\n".join(manifest) + "\n")
    _write_index(folder, fleet, rng)
    text = json.dumps([r.plain() for r in fleet], indent=1)
    (folder / "envelope.json").write_text(text)
    (folder / "envelope.sha256").write_text(hashlib.sha256(text.encode()).hexdigest() + "\n")
    return folder / "fleet.toml"


def _write_index(folder: Path, fleet: Sequence[PlannedRobot], rng: np.random.Generator) -> None:
    with (folder / "recordings.csv").open("w", newline="") as stream:
        table = csv.writer(stream)
        table.writerow(["robot", "make", "file", "date", "temperature"])
        for robot in fleet:
            for k, date in enumerate(robot.dates):
                recording, seen = record(robot, k, rng, folder)
                file = f"recordings/{robot.name}/{date:%Y-%m-%d}.parquet"
                write_recording(recording, folder / file)
                table.writerow([robot.name, robot.make, file, date.isoformat(), f"{seen:.2f}"])


def record(robot: PlannedRobot, k: int, rng: np.random.Generator, folder: Path) -> tuple[Recording, float]:
    """The k-th recording of a robot, and the temperature that its thermometer shows [°C]."""
    nominal = lagnet.load_robot(str(folder / f"{robot.make}.urdf"))
    time, q, v, a = motion(nominal.n_dof, rng)
    fate, since = robot.fate, k >= robot.fate.since
    bodies = nominal
    if fate.kind == "tool" and since:
        changed = nominal.inertial_parameters().copy()
        reach = MAKES[robot.make][-1][2]
        changed[-1, :4] += fate.size * np.array([1.0, reach, 0.0, 0.0])
        changed[-1, 4:] += fate.size * reach**2 * np.array([0.0, 0.0, 1.0, 0.0, 0.0, 1.0])
        bodies = nominal.with_inertial_parameters(changed)
    load = bodies.inverse_dynamics(q, v, a)
    warmth = np.exp(robot.per_kelvin * (robot.temperatures[k] - REFERENCE))
    worn = np.ones(nominal.n_dof)
    if fate.kind == "wear":
        worn[fate.joint] += fate.size * k / (len(robot.dates) - 1)
    dry = np.array(robot.dry) + LOADED * np.abs(load)
    tau = load + warmth * worn * (np.array(robot.viscous) * v + dry * np.tanh(v / SHARP))
    if fate.kind == "gain" and since:
        tau[:, fate.joint] *= 1.0 + fate.size
    tau = tau + TORQUE_NOISE * rng.standard_normal(tau.shape)
    seen = robot.temperatures[k] + THERMOMETER * rng.standard_normal()
    return Recording(time, q + ANGLE_NOISE * rng.standard_normal(q.shape), tau, nominal.joints), seen


def motion(dof: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Sums of sines, of other sizes every day: time (n,), q, v, a (n, dof)."""
    time = np.arange(int(SECONDS * RATE)) / RATE
    omega = 2.0 * np.pi * rng.uniform(0.08, 0.8, (WAVES, dof))
    size = rng.uniform(0.12, 0.35, (WAVES, dof)) * rng.uniform(0.7, 1.3) / np.sqrt(1.0 + (omega / 3.0) ** 2)
    angle = omega * time[:, None, None] + rng.uniform(0.0, 2.0 * np.pi, (WAVES, dof))
    q, v = (size * np.sin(angle)).sum(axis=1), (size * omega * np.cos(angle)).sum(axis=1)
    return time, q, v, -(size * omega**2 * np.sin(angle)).sum(axis=1)
