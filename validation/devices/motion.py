"""Sums of sines in all joints of a UR-5, with the torque that its bodies need, in a file.

python -m validation.devices.motion FILE

Apart from what is measured: a machine with a device may have no Pinocchio.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

import lagnet
from lagnet.recordings.recording import Recording

MOTION = "motion.npz"
TRAIN, HELD_OUT = 40_000, 8_000
COLUMNS = ("time", "q", "v", "a", "tau")
RATE, WAVES = 100.0, 5


def write_motion(path: Path) -> None:
    """Motion to train on and to judge by: time, positions, speeds, accelerations and torques of each."""
    robot = lagnet.load_robot("ur5")
    pair = [_motion(robot, samples, seed) for seed, samples in enumerate((TRAIN, HELD_OUT))]
    columns = {f"{name}_{i}": x for i, one in enumerate(pair) for name, x in one.items()}
    np.savez(path, joints=np.array(robot.joints), **columns)


def _motion(robot: Any, samples: int, seed: int) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(seed)
    t = np.arange(samples)[:, None, None] / RATE
    omega = 2.0 * np.pi * rng.uniform(0.05, 0.6, (WAVES, robot.n_dof))
    size = rng.uniform(0.2, 0.6, omega.shape) / (1.0 + omega)
    phase = omega * t + rng.uniform(0.0, 2.0 * np.pi, omega.shape)
    q, v, a = (
        np.sum(x, axis=1)
        for x in (size * np.sin(phase), size * omega * np.cos(phase), -size * omega**2 * np.sin(phase))
    )
    return {"time": t[:, 0, 0], "q": q, "v": v, "a": a, "tau": robot.inverse_dynamics(q, v, a)}


def read_motion(path: Path, samples: tuple[int, int]) -> tuple[Recording, Recording]:
    """The first samples of both."""
    with np.load(path, allow_pickle=False) as file:
        joints = tuple(map(str, file["joints"]))
        parts = [
            {name: file[f"{name}_{i}"][:n] for name in ("time", "q", "v", "a", "tau")} for i, n in enumerate(samples)
        ]
    one, other = (Recording(p["time"], p["q"], p["tau"], joints, v=p["v"], a=p["a"]) for p in parts)
    return one, other


if __name__ == "__main__":
    write_motion(Path(sys.argv[1]))
