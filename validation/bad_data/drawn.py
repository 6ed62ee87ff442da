"""Corruptions drawn by a seed over five arms, two of them real, each diagnosed, and their names counted."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path

import numpy as np

import lagnet
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.robot import Robot
from validation.bad_data.corruptions import CORRUPTIONS, Corruption
from validation.bad_data.row import Row, diagnosed, names_of
from validation.bad_data.sound import SoundSettings, sound_recording

SIMULATED, REAL = ("ur5", "panda", "kinova"), ("ur10e", "staubli_tx40")
ARMS = (*SIMULATED, *REAL)
DRAWN, SEED = 60, 1
UR10E_CONSTANTS = (14.87, 13.26, 11.13, 10.62, 11.03, 11.47)  # [N m/A], the authors' identification


def plant(robot: Robot, seed: int) -> list[Recording]:
    """Three sound recordings of an arm with viscous friction at its second joint and a spring at its third."""
    rng, out = np.random.default_rng(seed), []
    for k in range(3):
        r = sound_recording(robot, SoundSettings(viscous=0.0), rng, path=f"run_{k}.csv")
        speed = np.gradient(r.q, r.time, axis=0)
        added = np.zeros_like(r.tau)
        added[:, 1], added[:, 2] = 12.0 * speed[:, 1], 15.0 * (r.q[:, 2] - 0.2)
        out.append(Recording(r.time, r.q, r.tau + added, r.joints, path=r.path))
    return out


def planted(robot: Robot) -> set[str]:
    """Names of what acts in `plant`."""
    return {f"viscous_friction at {robot.joints[1]}", f"joint_spring at {robot.joints[2]}"}


def drawn(arms: Collection[str] = ARMS) -> list[Row]:
    """The rows of some of the arms; what is drawn for an arm does not depend on which others are asked for."""
    right: dict[str, set[str]] = {}
    rows = []
    for arm, robot, sound, corruption, broken in _draws():
        if arm not in arms:
            continue
        if arm not in right:
            right[arm] = planted(robot) if arm in SIMULATED else set(names_of(lagnet.diagnose(sound, robot).verdict))
        rows.append(diagnosed(robot, arm, corruption, broken, right[arm]))
    return rows


def _draws() -> Iterator[tuple[str, Robot, list[Recording], Corruption, list[Recording]]]:
    """Arm by arm in turn: its name, model, sound recordings, a corruption, and the recordings after it."""
    rng = np.random.default_rng(SEED)
    read = [(name, lagnet.load_robot(name), None) for name in SIMULATED] + [(n, *_real(n)) for n in REAL]
    for k in range(DRAWN):
        name, robot, recordings = read[k % len(read)]
        sound = list(recordings or plant(robot, 100 + k))
        fitting = [c for c in CORRUPTIONS if c.least_joints <= robot.n_dof and _changes(c, robot.joints)]
        corruption = fitting[int(rng.integers(len(fitting)))]
        yield name, robot, sound, corruption, corruption.do(list(sound), rng)


def _changes(corruption: Corruption, joints: tuple[str, ...]) -> bool:
    """Whether the alphabetical order is another than the model's."""
    return "alphabetical" not in corruption.name or list(joints) != sorted(joints)


def _real(name: str) -> tuple[Robot, list[Recording]]:
    data = Path(os.environ["LAGNET_DATA_DIR"]) / name
    robot = lagnet.load_robot(next(data.glob("*.urdf")))
    constants = UR10E_CONSTANTS if name == "ur10e" else None
    files = sorted(data.glob("fit*.csv.gz"))[:3]
    return robot, [lagnet.load_recording(f, robot=robot, torque_constant=constants) for f in files]


def names_counted(rows: Sequence[Row]) -> dict:
    """Causes told, and names held against the right ones, of all arms and of each."""
    return {**_counted(rows), "by_arm": {arm: _counted([r for r in rows if r.arm == arm]) for arm in _arms_of(rows)}}


def _arms_of(rows: Sequence[Row]) -> list[str]:
    return list(dict.fromkeys(r.arm for r in rows))


def _counted(rows: Sequence[Row]) -> dict:
    made = [r for r in rows if r.names is not None]
    return {
        "rows": len(rows),
        "cause_told": sum(r.cause_told for r in rows),
        "refused": len(rows) - len(made),
        "names": sum(len(r.names) for r in made),
        "wrong_names_cause_told": sum(r.wrong_names for r in made if r.cause_told),
        "wrong_names_cause_not_told": sum(r.wrong_names for r in made if not r.cause_told),
        "rows_with_a_wrong_name": sum(bool(r.wrong_names) for r in made),
        "lost_names": sum(r.lost_names for r in made),
        "slowest_cpu_s": max((r.cpu_seconds for r in rows), default=0.0),
    }
