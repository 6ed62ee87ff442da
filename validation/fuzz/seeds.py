"""Sound files of every kind that lagnet reads, from which broken ones are made."""

from __future__ import annotations

import gzip
import shutil
from pathlib import Path

import numpy as np
import scipy.io

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


def write_seeds(folder: Path) -> dict[str, tuple[Path, ...]]:
    """Writes the sound files; their paths by what reads them: recording, map, effects, robot, model."""
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
    (folder / "effects.toml").write_text(EFFECTS, encoding="utf-8")
    return {
        "recording": (*records, folder / "run.mat"),
        "map": (folder / "map.toml",),
        "effects": (folder / "effects.toml",),
        "robot": (folder / "arm.urdf", folder / "arm.xml"),
        "model": _models(folder, robot),
    }


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
