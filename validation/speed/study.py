"""Time and memory of diagnoses of growing size, each in a process of its own.

python -m validation.speed.study [--quick | --profile]
"""

from __future__ import annotations

import argparse
import cProfile
import json
import os
import pstats
import resource
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

from lagnet.diagnosis.diagnose import diagnose
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.robot import load_description

HERE = Path(__file__).resolve().parent
RATE = 100.0  # [Hz]
SMALL = (3_000, 3)  # samples of a recording, recordings
SIZES = (250_000, 500_000, 1_000_000)
SECONDS_SMALL, SECONDS_LARGE, MEMORY, EXPONENT = 20.0, 120.0, 2.0e9, 1.15
CHUNK = 50_000  # samples whose torque is computed at once when a recording is made


def make_recording(robot: Any, samples: int, seed: int) -> Recording:
    """Six joints in motion, with friction, noise and an encoder's noise."""
    rng, n = np.random.default_rng(seed), robot.n_dof
    omega = 2.0 * np.pi * rng.uniform(0.05, 0.5, (5, n))
    size, phase = rng.uniform(0.1, 0.3, (5, n)), rng.uniform(0.0, 6.0, (5, n))
    viscous, dry = rng.uniform(1.0, 6.0, n), rng.uniform(1.0, 5.0, n)
    time_ = np.arange(samples) / RATE
    q, tau = np.empty((samples, n)), np.empty((samples, n))
    for start in range(0, samples, CHUNK):
        rows = slice(start, min(start + CHUNK, samples))
        angle = omega * time_[rows, None, None] + phase
        v = (size * omega * np.cos(angle)).sum(axis=1)
        q[rows] = (size * np.sin(angle)).sum(axis=1)
        tau[rows] = robot.inverse_dynamics(q[rows], v, -(size * omega**2 * np.sin(angle)).sum(axis=1))
        tau[rows] += viscous * v + dry * np.tanh(v / 1e-3)
    tau += 0.01 * np.std(tau, axis=0) * rng.standard_normal(tau.shape)
    return Recording(time_, q + 1e-5 * rng.standard_normal(q.shape), tau, robot.joints)


def child(samples: int, recordings: int) -> None:
    """One diagnosis; prints its time, the memory of the process and what was named, as JSON."""
    robot = load_description("ur5")
    made = [make_recording(robot, samples, seed) for seed in range(recordings)]
    start, busy = time.perf_counter(), time.process_time()
    result = diagnose(made, robot)
    seconds = time.perf_counter() - start
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    processor = time.process_time() - busy
    found = sorted({e.effect for e in result.effects})
    times = {"seconds": round(seconds, 2), "processor_seconds": round(processor, 2)}
    print(json.dumps(times | {"memory_bytes": memory, "effects": found}))


def measure(samples: int, recordings: int = 1) -> dict[str, Any]:
    """Runs a child with one thread."""
    single = {n: "1" for n in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")}
    command = [sys.executable, "-m", "validation.speed.study", "--child", str(samples), str(recordings)]
    load = os.getloadavg()[0]
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=os.environ | single)
    result = json.loads(done.stdout.splitlines()[-1])
    result |= {"samples": samples, "recordings": recordings, "load_before": round(load, 1)}
    print(result, flush=True)
    return result


def exponent(cases: list[dict[str, Any]]) -> float:
    """Slope of log time over log samples."""
    return float(np.polyfit(np.log([c["samples"] for c in cases]), np.log([c["seconds"] for c in cases]), 1)[0])


def judge(small: dict[str, Any], large: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Pass lines."""
    growth = exponent(large)
    lines = [
        ("three recordings of 3,000 × 6 within 20 s", small["seconds"], small["seconds"] <= SECONDS_SMALL),
        ("a million × 6 within 120 s", large[-1]["seconds"], large[-1]["seconds"] <= SECONDS_LARGE),
        ("a million × 6 within 2 GB", large[-1]["memory_bytes"], large[-1]["memory_bytes"] <= MEMORY),
        ("time grows with an exponent of at most 1.15", round(growth, 3), growth <= EXPONENT),
    ]
    return [{"claim": c, "found": f, "passed": bool(p)} for c, f, p in lines]


def profile(samples: int = 100_000) -> None:
    """Prints where the time goes."""
    robot = load_description("ur5")
    recording = make_recording(robot, samples, 0)
    watch = cProfile.Profile()
    watch.runcall(diagnose, [recording], robot)
    pstats.Stats(watch).sort_stats("tottime").print_stats(25)


def main() -> int:
    """Run the study; 0 if every line is passed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="the smallest case alone; writes nothing")
    parser.add_argument("--profile", action="store_true", help="print where the time goes")
    parser.add_argument("--child", nargs=2, type=int, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.child:
        child(*options.child)
        return 0
    if options.profile:
        profile()
        return 0
    small = measure(*SMALL)
    if options.quick:
        return 0 if small["seconds"] <= SECONDS_SMALL else 1
    large = [measure(samples) for samples in SIZES]
    lines = judge(small, large)
    passed = all(line["passed"] for line in lines)
    result = {"study": "speed", "passed": passed, "processors": os.cpu_count(), "cases": [small, *large]}
    (HERE / "result.json").write_text(json.dumps(result | {"lines": lines}, indent=1, ensure_ascii=False) + "\n")
    for line in lines:
        print(f"{'met    ' if line['passed'] else 'NOT MET'} {line['claim']}: {line['found']}")
    return 0 if passed else 1


if __name__ == "__main__":
    raise SystemExit(main())
