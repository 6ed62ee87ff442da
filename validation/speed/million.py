"""`lagnet diagnose` on files of a million samples of six joints: seconds, memory, and whether the verdict is right.

python -m validation.speed.million
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from lagnet.rigid_body.robot import load_description

HERE = Path(__file__).resolve().parent
SAMPLES, CHUNK = 1_000_000, 50_000
RATES = (100.0, 1000.0)  # [Hz]
SECONDS = 60.0
MASS, CENTRE, INERTIA = 2.0, np.array([0.02, -0.03, 0.06]), np.diag([4e-3, 5e-3, 3e-3])  # of the payload
CLOSE = 0.02  # relative error that a parameter may have


def write_file(path: Path, rate: float, seed: int = 0) -> dict[str, list[float]]:
    """A UR-5 with a payload and friction that its model does not have, 1 % noise on torque; gives the friction back."""
    robot, rng = load_description("ur5"), np.random.default_rng(seed)
    n, truth = robot.n_dof, robot.with_payload(MASS, CENTRE, INERTIA)
    omega = 2.0 * np.pi * rng.uniform(0.05, 0.5, (5, n))
    size, phase = rng.uniform(0.1, 0.3, (5, n)), rng.uniform(0.0, 6.0, (5, n))
    viscous, dry = rng.uniform(1.0, 6.0, n), rng.uniform(1.0, 5.0, n)
    time_ = np.arange(SAMPLES) / rate
    q, tau = np.empty((SAMPLES, n)), np.empty((SAMPLES, n))
    for start in range(0, SAMPLES, CHUNK):
        rows = slice(start, min(start + CHUNK, SAMPLES))
        angle = omega * time_[rows, None, None] + phase
        v, a = (size * omega * np.cos(angle)).sum(axis=1), -(size * omega**2 * np.sin(angle)).sum(axis=1)
        q[rows] = (size * np.sin(angle)).sum(axis=1)
        tau[rows] = truth.inverse_dynamics(q[rows], v, a) + viscous * v + dry * np.tanh(v / 1e-3)
    tau += 0.01 * np.std(tau, axis=0) * rng.standard_normal(tau.shape)
    q += 1e-5 * rng.standard_normal(q.shape)
    columns = {f"q_{i}": q[:, i] for i in range(n)} | {f"tau_{i}": tau[:, i] for i in range(n)}
    pq.write_table(pa.table({"time": time_} | columns), path)
    return {"viscous_friction": viscous.tolist(), "coulomb_friction": dry.tolist()}


def measure(rate: float, folder: Path) -> dict[str, Any]:
    """The command in a process of its own."""
    file, out = folder / f"{rate:.0f}.parquet", folder / f"out_{rate:.0f}"
    truth = write_file(file, rate)
    command = [sys.executable, "-m", "lagnet", "diagnose", str(file), "--robot", "ur5", "--out", str(out)]
    load, start = os.getloadavg()[0], time.perf_counter()
    process = os.spawnv(os.P_NOWAIT, sys.executable, command)
    _, status, usage = os.wait4(process, 0)
    wrong = ["the command failed"] if status else errors(json.loads((out / "verdict.json").read_text()), truth)
    return {
        "rate_hz": rate,
        "seconds": round(time.perf_counter() - start, 1),
        "processor_seconds": round(usage.ru_utime + usage.ru_stime, 1),
        "memory_bytes": usage.ru_maxrss * 1024,
        "load_before": round(load, 1),
        "wrong": wrong,
    }


def errors(verdict: dict[str, Any], truth: dict[str, list[float]]) -> list[str]:
    """Names that are wrong, missing, or with a parameter that is off."""
    joints, wrong = load_description("ur5").joints, []
    wanted = {(k, j): x for k, values in truth.items() for j, x in zip(joints, values, strict=True)}
    wanted |= {("payload", None): MASS}
    found = {(e["effect"], e["joint"]): e["parameters"][0]["value"] for e in verdict["effects"]}
    wrong += [f"{k[0]} at {k[1]} is not there" for k in found if k not in wanted]
    wrong += [f"{k[0]} at {k[1]} is not named" for k in wanted if k not in found]
    off = [k for k in found if k in wanted and abs(found[k] - wanted[k]) > CLOSE * abs(wanted[k])]
    return wrong + [f"{k[0]} at {k[1]}: {found[k]:.4g}, truth {wanted[k]:.4g}" for k in off]


def main() -> int:
    """Run the study; 0 if both files take at most a minute and all names are right."""
    cases: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as folder:
        for rate in RATES:
            cases.append(measure(rate, Path(folder)))
            print(cases[-1], flush=True)
            passed = len(cases) == len(RATES) and all(c["seconds"] <= SECONDS and not c["wrong"] for c in cases)
            result = {"study": "million_samples", "passed": passed, "processors": os.cpu_count(), "cases": cases}
            (HERE / "million.json").write_text(json.dumps(result, indent=1) + "\n")
    return 0 if passed else 1


if __name__ == "__main__":
    raise SystemExit(main())
