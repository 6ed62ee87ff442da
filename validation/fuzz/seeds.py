"""Sound files of every kind that lagnet reads, from which broken ones are made."""

from __future__ import annotations

import gzip
import shutil
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import scipy.io
from tests.recordings.made_logs import MAKERS

from lagnet.recordings.recording import Recording
from lagnet.recordings.writing import write_recording
from lagnet.rigid_body.robot import load_description

LEARNED = Path(__file__).resolve().parents[2] / "tests" / "models" / "fixtures" / "ur5_delan"
MAP = """[columns]
time = "t"
q = "actual_q_{i}"
tau = "effort_{i}"
[scale]
time = 1e-3
"q_0" = 0.0174533
[offset]
"q_1" = -1.5
[torque_constant]
values = [10.0, 11.0]
"""
EFFECTS = """[[effect]]
name = "viscous_friction"
joint = "shoulder_lift_joint"
Fv = 2.0
[[effect]]
name = "payload"
m = 1.0
cx = 0.0
cy = 0.0
cz = 0.1
Ixx = 0.01
Ixy = 0.0
Iyy = 0.01
Ixz = 0.0
Iyz = 0.0
Izz = 0.01
"""


SERVO = """[all]
kp = 30.0
kd = 1.0
delay = 0.01
[elbow_joint]
torque_limit = 100.0
damping = 0.5
"""
MANIFEST = """[settings]
seed = 1
[[make]]
name = "arm"
robot = "arm.urdf"
[[robot]]
name = "arm_01"
make = "arm"
[[robot.recordings]]
files = "run.csv"
date = 2026-01-31
"""


@dataclass(frozen=True)
class Seed:
    """A sound input.

    Args:
        read: file or folder that is given to a reader.
        changed: the file in it, or itself, that is broken.
    """

    read: Path
    changed: Path


def write_seeds(folder: Path) -> dict[str, tuple[Seed, ...]]:
    """Writes the sound inputs, by what reads them: recording, log, map, effects, servo, manifest, robot, model."""
    rng = np.random.default_rng(0)
    time = np.arange(60) / 100.0
    q = np.sin(time[:, None] * np.array([3.0, 4.0])) + 1e-4 * rng.standard_normal((60, 2))
    recording = Recording(time, q, 2.0 * q, ("shoulder", "elbow"), v=np.gradient(q, time, axis=0))
    records = [write_recording(recording, folder / f"run{s}") for s in (".csv", ".csv.gz", ".parquet", ".npz")]
    scipy.io.savemat(folder / "run.mat", {"time": time, "q": q, "tau": 2.0 * q})
    robot = load_description("ur5")
    robot.write_urdf(folder / "arm.urdf")
    robot.write_mjcf(folder / "arm.xml")
    (folder / "map.toml").write_text(MAP, encoding="utf-8")
    for name, text in (("map", MAP), ("effects", EFFECTS), ("servo", SERVO), ("manifest", MANIFEST)):
        (folder / f"{name}.toml").write_text(text, encoding="utf-8")
    texts = {name: (folder / f"{name}.toml",) for name in ("map", "effects", "servo", "manifest")}
    files = {"recording": (*records, folder / "run.mat"), **texts, "robot": (folder / "arm.urdf", folder / "arm.xml")}
    alone = {kind: tuple(Seed(path, path) for path in paths) for kind, paths in files.items()}
    models = tuple(Seed(path.parent, path) for path in _models(folder, robot))
    return alone | {"log": _logs(folder / "logs"), "model": models}


def _logs(folder: Path) -> tuple[Seed, ...]:
    """Logs of other programs, each in a folder of its own; of those that are folders, every file."""
    seeds: list[Seed] = []
    for index, make in enumerate(MAKERS.values()):
        (folder / str(index)).mkdir(parents=True)
        read = make(folder / str(index))
        inside = sorted(path for path in read.rglob("*") if path.is_file()) if read.is_dir() else [read]
        seeds += [Seed(read, path) for path in inside]
    return tuple(seeds)


def _models(folder: Path, robot) -> tuple[Path, ...]:
    """Files of a corrected and of a learned model; all else in their folders stays sound."""
    from lagnet.models.corrected.folder import save_corrected
    from lagnet.models.corrected.model import CorrectedModel, NamedEffect

    effect = NamedEffect("viscous_friction", 1, {"Fv": 2.0})
    save_corrected(CorrectedModel(robot, (effect,), np.full(robot.n_dof, 0.01)), folder / "corrected_model")
    learned = shutil.copytree(LEARNED, folder / "learned_model")
    corrected = folder / "corrected_model"
    return corrected / "corrected.json", learned / "model.json", learned / "model.json", learned / "weights.npz"


def plain(data: bytes) -> tuple[bytes, bool]:
    """The bytes less their gzip coat, and whether they had one."""
    coated = data[:2] == b"\x1f\x8b"
    return (gzip.decompress(data), True) if coated else (data, False)
