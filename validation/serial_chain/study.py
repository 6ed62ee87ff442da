"""Can an arm be found from torque alone? Run: python validation/serial_chain/study.py [--quick]"""

from __future__ import annotations

import argparse
import json
import os
import time
from pathlib import Path

import numpy as np
import scipy.io

from lagnet.models.serial_chain.mechanics.joint_terms import JOINT_TERMS
from lagnet.models.serial_chain.model import learn_serial_chain
from lagnet.models.serial_chain.settings import SearchSettings, SerialChainSettings
from lagnet.rigid_body.random_arm import random_arm
from lagnet.rigid_body.robot import Robot, load_description

FOLDER = Path(__file__).resolve().parent
DATA = Path(os.environ.get("LAGNET_DATA_DIR", FOLDER.parents[2] / "shared" / "data"))
EXACT, NOISY = 1e-12, 1e-5  # pass lines: nMSE of every term
SECONDS = {"ur5": 60.0, "panda": 600.0, "xarm7": 600.0, "prismatic4": 600.0}


def arm(name: str) -> Robot:
    """A robot of example-robot-data, or a random one of four joints with one that slides."""
    if name != "prismatic4":
        return load_description(name)
    for seed in range(100):
        robot = random_arm(4, seed, kinds=("revolute", "revolute", "prismatic"))
        if [kind == "prismatic" for kind in robot.joint_types].count(True) == 1:
            return robot
    raise RuntimeError("no such arm among the seeds tried")


def motion(robot: Robot, n: int, seed: int) -> tuple[np.ndarray, ...]:
    """Positions uniform within the limits (one turn at most), speeds of 1 and accelerations of 2."""
    rng = np.random.default_rng(seed)
    low, high = (np.clip(x, -np.pi, np.pi) for x in (robot.position_lower, robot.position_upper))
    shape = (n, robot.n_dof)
    return rng.uniform(low, high, shape), rng.normal(size=shape), 2.0 * rng.normal(size=shape)


def terms(model, robot: Robot, n: int = 1000) -> dict:
    """nMSE of every term on fresh motion, per joint where it has joints."""
    q, v, a = motion(robot, n, 10_007)
    pairs = {
        "torque": (model.inverse_dynamics(q, v, a), robot.inverse_dynamics(q, v, a)),
        "inertial": tuple(np.einsum("nij,nj->ni", m.mass_matrix(q), a) for m in (model, robot)),
        "coriolis": (model.coriolis_torque(q, v), robot.coriolis_torque(q, v)),
        "gravity": (model.gravity_torque(q), robot.gravity_torque(q)),
    }
    out = {name: _nmse(got, want).tolist() for name, (got, want) in pairs.items()}
    for name, got, want in (
        ("mass_matrix", model.mass_matrix(q), robot.mass_matrix(q)),
        ("coriolis_matrix", model.coriolis_matrix(q, v), robot.coriolis_matrix(q, v)),
    ):
        out[name] = [float(np.sum((got - want) ** 2) / np.sum(want**2))]
    tau = robot.inverse_dynamics(q, v, a)
    out["forward_dynamics"] = _nmse(model.forward_dynamics(q, v, tau), a).tolist()
    return out


def _nmse(got: np.ndarray, want: np.ndarray) -> np.ndarray:
    """Per joint; where a joint's term is below rounding of the largest, its error counts against the largest."""
    variance = want.var(axis=0)
    scale = np.where(variance > 1e-16 * variance.max(), variance, variance.max())
    return np.mean((got - want) ** 2, axis=0) / scale


def case(name: str, samples: int, noise: float, seed: int) -> dict:
    """Fit one arm and hold every term against Pinocchio."""
    robot = arm(name)
    q, v, a = motion(robot, samples, seed)
    clean = robot.inverse_dynamics(q, v, a)
    tau = clean + noise * clean.std(axis=0) * np.random.default_rng(seed + 1).normal(size=clean.shape)
    wall, cpu = time.perf_counter(), time.process_time()
    model, found = learn_serial_chain(q, v, a, tau, robot.joints, robot.joint_types, seed)
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    errors = terms(model, robot)
    limit = NOISY if noise else EXACT
    held = {key: value for key, value in errors.items() if key != "forward_dynamics"}
    worst = max(max(values) for values in held.values())
    in_time = bool(noise) or min(wall, cpu) <= SECONDS[name]
    return {
        "arm": name, "joints": robot.n_dof, "samples": samples, "noise": noise, "seed": seed,
        "seconds": round(wall, 1), "cpu_seconds": round(cpu, 1), "nmse": errors, "worst_term": worst, "limit": limit,
        "exact_enough": worst <= limit, "in_time": in_time, "passed": worst <= limit and in_time,
        "links_can_exist": found.physical, "axes_costs": found.axes_costs.tolist(),
        "lengths_costs": found.lengths_costs.tolist(), "base_rank": found.determinacy.base_rank,
        "shape_rank": found.determinacy.shape_rank, "determined": int(found.determinacy.determined.sum()),
    }  # fmt: skip


def sarcos(quick: bool) -> dict:
    """What a serial chain with every joint term leaves of the torque of a real arm, on rows kept from fitting."""
    rows = scipy.io.loadmat(DATA / "sarcos" / "sarcos_inv_test.mat")["sarcos_inv_test"]
    rows = rows[np.random.default_rng(0).permutation(len(rows))]
    q, v, a, tau = (rows[:, 7 * k : 7 * k + 7] for k in range(4))
    fit, rest = slice(0, 3559), slice(3559, None)
    starts = SearchSettings(least_starts=8, most_starts=8) if quick else SearchSettings(least_starts=24, most_starts=32)
    settings = SerialChainSettings(joint_terms=JOINT_TERMS, search=starts, candidates=1 if quick else 2, reweighings=1)
    names, kinds = tuple(f"joint_{i}" for i in range(7)), ("revolute",) * 7
    began = time.perf_counter()
    model, found = learn_serial_chain(q[fit], v[fit], a[fit], tau[fit], names, kinds, 0, settings)
    residual = tau[rest] - model.inverse_dynamics(q[rest], v[rest], a[rest])
    squared = np.mean(residual**2, axis=0)
    return {
        "rows_fitted": 3559, "rows_judged": len(rows) - 3559, "seconds": round(time.perf_counter() - began, 1),
        "mse": squared.tolist(), "summed_mse": float(squared.sum()), "nmse": (squared / tau[rest].var(axis=0)).tolist(),
        "links_can_exist": found.physical, "nmse_if_links_can_exist": found.physical_nmse.tolist(),
        "axes_costs": found.axes_costs.tolist(), "lengths_costs": found.lengths_costs.tolist(),
    }  # fmt: skip


def main() -> int:
    """Run the cases and write result.json after each, or print alone with --quick."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="one small arm and the UR-5; nothing is written")
    quick = parser.parse_args().quick
    cases = [("prismatic4", 500, 0.0), ("ur5", 500, 0.0)]
    if not quick:
        cases += [("xarm7", 500, 0.0), ("panda", 500, 0.0), ("ur5", 10_000, 0.01)]
    result: dict = {"cases": [], "complete": False}
    for name, samples, noise in cases:
        result["cases"].append(case(name, samples, noise, seed=0))
        last = result["cases"][-1]
        print({key: last[key] for key in ("arm", "samples", "noise", "seconds", "worst_term", "passed")}, flush=True)
        _write(result, quick)
    if (DATA / "sarcos").is_dir() and not quick:
        result["sarcos"] = sarcos(quick)
        print(result["sarcos"])
    result["complete"] = True
    result["passed"] = all(one["passed"] for one in result["cases"])
    _write(result, quick)
    return 0 if result["passed"] else 1


def _write(result: dict, quick: bool) -> None:
    if not quick:
        (FOLDER / "result.json").write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    raise SystemExit(main())
