"""Diagnose plants blindly: each in a process of its own, in an empty folder that holds the recordings alone."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

FIT, HOLDOUT = ("fit_0.csv", "fit_1.csv", "fit_2.csv"), "holdout.csv"
PATIENCE = 600  # [s] after which a diagnosis counts as failed
INHERITED = ("PATH", "LANG", "LC_ALL", "VIRTUAL_ENV", "SYSTEMROOT")


@dataclass(frozen=True)
class BlindResult:
    """What came back from one diagnosis.

    Args:
        name: of the plant.
        verdict: the content of verdict.json; None where the diagnosis failed.
        sha256: of verdict.json.
        seconds: wall time of the whole command.
        message: what the command printed last, where it failed.
        folder: where verdict and held-out torques lie.
    """

    name: str
    verdict: dict | None
    sha256: str
    seconds: float
    message: str
    folder: Path


def diagnose_blind(plant: Path, out: Path) -> BlindResult:
    """Run `lagnet diagnose` on one plant's recordings and nominal model; keep verdict and held-out torques."""
    robot = (plant / "nominal.txt").read_text().strip()
    kept = out / plant.name
    with tempfile.TemporaryDirectory() as empty:
        for file in (*FIT, HOLDOUT):
            shutil.copy(plant / "recordings" / file, empty)
        command = [sys.executable, "-m", "lagnet.cli.main", "diagnose", *FIT]
        command += ["--holdout", HOLDOUT, "--robot", robot, "--out", "found"]
        began = time.perf_counter()
        done = _run(command, Path(empty))
        seconds = time.perf_counter() - began
        verdict = Path(empty) / "found" / "verdict.json"
        if done or not verdict.exists():
            return BlindResult(plant.name, None, "", seconds, done or "no verdict was written", kept)
        kept.mkdir(parents=True, exist_ok=True)
        for file in ("verdict.json", "holdout_torque.parquet"):
            shutil.copy(Path(empty) / "found" / file, kept)
    content = (kept / "verdict.json").read_bytes()
    return BlindResult(plant.name, json.loads(content), hashlib.sha256(content).hexdigest(), seconds, "", kept)


def _run(command: list[str], folder: Path) -> str:
    """Empty where the command succeeded, else its last words."""
    environment = {name: os.environ[name] for name in INHERITED if name in os.environ}
    environment |= {"HOME": str(folder), "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    try:
        done = subprocess.run(
            command, cwd=folder, env=environment, capture_output=True, text=True, timeout=PATIENCE, check=False
        )
    except subprocess.TimeoutExpired:
        return f"no verdict after {PATIENCE} s"
    return "" if done.returncode == 0 else (done.stderr.strip().splitlines() or ["failed without a word"])[-1]


def diagnose_all(plants: Sequence[Path], out: Path, processes: int = 2) -> list[BlindResult]:
    """Diagnose plants, so many at a time, in the order given."""
    with ThreadPoolExecutor(processes) as pool:
        results = []
        for result in pool.map(diagnose_blind, plants, [out] * len(plants)):
            print(result.name, f"{result.seconds:.1f} s", result.message, flush=True)
            results.append(result)
    return results
