"""Published sets of real robots against two halves of their recordings: does the second contradict the first?"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

import lagnet
from lagnet.comparison.compare import compare
from lagnet.comparison.motion import compare_motion, servo_driven
from lagnet.comparison.writing import short_names
from lagnet.recordings.conditioning.condition import condition
from lagnet.recordings.loading.load import load_recording
from lagnet.servos.servo_file import servo_of_values

UR10E_CONSTANTS = (14.87, 13.26, 11.13, 10.62, 11.03, 11.47)  # [N m/A], the authors' identification
# STS3215 servos of the SO-101 as published: its MJCF (class sts3215), the defaults of the same file, Open Duck Mini.
SO101 = {
    "SO-ARM100 MJCF": {
        "kp": 998.22, "kd": 2.731, "viscous": 0.6, "coulomb": 0.052, "rotor": 0.028, "torque_limit": 2.94
    },
    "its defaults": {"kp": 50.0, "viscous": 1.0, "coulomb": 0.1, "rotor": 0.005},
    "Open Duck Mini": {"kp": 17.8, "viscous": 0.6, "coulomb": 0.052, "rotor": 0.028, "torque_limit": 3.35},
}  # fmt: skip
SO101_LOGS = (("multisine", "chirp_sweep"), ("step_response", "lissajous_pattern"))
SO101_MORE = (("prbs_excitation", "friction_gravity"), ("coupled_joints", "large_amplitude"))


def cases(data: Path, quick: bool) -> list[dict[str, Any]]:
    """Every real robot with more than one published set; the quick run has the servos alone."""
    motion = [_so101(data, SO101_LOGS if quick else (sum(SO101_LOGS, ()), sum(SO101_MORE, ())))]
    return motion if quick else [_ur10e(data), _ur10(data), _panda(data), *motion]


def _ur10e(data: Path) -> dict[str, Any]:
    files = [data / "ur10e" / f"{name}.csv.gz" for name in ("fit_0", "fit_1", "fit_2", "holdout")]
    robots = [str(data / "ur10e" / "ur10e.urdf"), "ur10"]
    return _torque("ur10e", robots, files[:2], files[2:], UR10E_CONSTANTS)


def _ur10(data: Path) -> dict[str, Any]:
    file = data / "bags" / "ur10_exciting_trajectory.db3"
    return _torque("ur10 (bag)", ["ur10", str(data / "ur10e" / "ur10e.urdf")], [file], None)


def _panda(data: Path) -> dict[str, Any]:
    """The Panda's file, and the same without the hand, whose mass is taken off its last link."""
    robot = lagnet.load_robot("panda")
    bare = robot.inertial_parameters().copy()
    bare[-1] *= 0.3
    sets, names = [robot, robot.with_inertial_parameters(bare)], ["panda", "panda, last link of 30 %"]
    files = [data / "panda" / f"{name}.csv.gz" for name in ("fit", "holdout")]
    return _run("panda", sets, names, [[load_recording(f, robot=robot)] for f in files])


def _torque(name: str, specs: list[str], first: list[Path], second: list[Path] | None, constants=None) -> dict:
    sets = [lagnet.load_robot(s) for s in specs]
    read = [[load_recording(f, robot=sets[0], torque_constant=constants) for f in g] for g in (first, second or [])]
    if second is None:
        read = [[r.rows(slice(0, len(r) // 2)) for r in read[0]], [r.rows(slice(len(r) // 2, None)) for r in read[0]]]
    return _run(name, sets, list(short_names(specs)), read)


def _run(name: str, sets: list[Any], names: list[str], halves: list[list[Any]]) -> dict[str, Any]:
    found = [compare(sets, names, half) for half in halves]
    ranked = [_ranked(sets, half) for half in halves]
    return _row(name, names, found, ranked)


def _ranked(sets: list[Any], recordings: list[Any]) -> np.ndarray:
    """The baseline: per joint the set with the smallest squared error of torque as it is, shape (dof,)."""
    stretches = condition(recordings).stretches
    power = [sum(np.sum((s.tau - m.inverse_dynamics(s.q, s.v, s.a)) ** 2, axis=0) for s in stretches) for m in sets]
    return np.argmin(np.array(power), axis=0)


def _so101(data: Path, groups: tuple[tuple[str, ...], ...]) -> dict[str, Any]:
    robot = lagnet.load_robot(str(data / "so101" / "so101.urdf"))
    sets = []
    for values in SO101.values():
        servo = servo_of_values({j: values for j in robot.joints}, robot.joints, robot.armature, "file")
        sets.append(servo_driven(robot, "so101", servo))
    halves = [[load_recording(data / "so101" / name, robot=robot) for name in group] for group in groups]
    found = [compare_motion(sets, list(SO101), half) for half in halves]
    ranked = []
    for half in halves:
        power = [sum(np.sum((s.rollout(r.command, r.time, r.q[0]) - r.q) ** 2, axis=0) for r in half) for s in sets]
        ranked.append(np.argmin(np.array(power), axis=0))
    return _row("so101", list(SO101), found, ranked)


def _row(name: str, names: list[str], found: list[Any], ranked: list[np.ndarray]) -> dict[str, Any]:
    joints = []
    for first, second, a, b in zip(found[0].joints, found[1].joints, *ranked, strict=True):
        both = not (first.also or second.also or first.alike or second.alike)
        joints.append(
            {
                "joint": first.joint,
                "first": _said(first, names),
                "second": _said(second, names),
                "nmse_percent": [[round(100 * min(float(x), 99.0), 3) for x in j.nmse] for j in (first, second)],
                "contradicted": bool(both and first.best != second.best),
                "baseline": [names[int(a)], names[int(b)]],
            }
        )
    differing = found[0].differences
    told = [d for d in differing or () if d.resolved]
    return {
        "robot": name,
        "sets": names,
        "joints": joints,
        "differences": None if differing is None else len(differing),
        "resolved": None if differing is None else len(told),
        "none_of_them": None if differing is None else sum(d.nearest is None for d in told),
        "reason": found[0].reason,
        "contradicted": sum(j["contradicted"] for j in joints),
        "baseline_contradicted": sum(j["baseline"][0] != j["baseline"][1] for j in joints),
    }


def _said(joint: Any, names: list[str]) -> str:
    if joint.alike:
        return "alike"
    return f"{names[joint.best]}" + (", or " + ", ".join(names[m] for m in joint.also) if joint.also else "")
