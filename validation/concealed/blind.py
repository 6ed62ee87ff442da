"""Diagnose one plant blindly: in a process of its own, in an empty folder that holds the recordings alone."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from validation.concealed.code import PACKAGE

PATIENCE = 900  # [s] after which a diagnosis counts as failed
INHERITED = ("PATH", "LANG", "LC_ALL", "VIRTUAL_ENV", "SYSTEMROOT")


@dataclass(frozen=True)
class Blind:
    """What came back from one diagnosis.

    Args:
        verdict: bytes of verdict.json; empty where there is none.
        torques: bytes of holdout_torque.parquet.
        seconds, processor_seconds: of the whole command, from its start to its end.
        message: its last words, where it failed.
    """

    verdict: bytes
    torques: bytes
    seconds: float
    processor_seconds: float
    message: str


def diagnose_blind(recordings: Path, names: tuple[str, ...], robot: str) -> Blind:
    """`lagnet diagnose` on recordings, the last of which is held out, and the name of the nominal robot."""
    with tempfile.TemporaryDirectory() as empty:
        for name in names:
            shutil.copy(recordings / f"{name}.csv", empty)
        files = [f"{name}.csv" for name in names]
        command = [sys.executable, "-m", "lagnet.cli.main", "diagnose", *files[:-1]]
        command += ["--holdout", files[-1], "--robot", robot, "--out", "found"]
        began = time.perf_counter()
        message, processor = _run(command, Path(empty))
        seconds = time.perf_counter() - began
        found = [Path(empty) / "found" / name for name in ("verdict.json", "holdout_torque.parquet")]
        if message or not all(file.exists() for file in found):
            return Blind(b"", b"", seconds, processor, message or "no verdict was written")
        return Blind(found[0].read_bytes(), found[1].read_bytes(), seconds, processor, "")


def _run(command: list[str], folder: Path) -> tuple[str, float]:
    """Last words where the command failed, else none; and its processor time [s]."""
    environment = {name: os.environ[name] for name in INHERITED if name in os.environ}
    environment |= {
        "PYTHONPATH": str(PACKAGE.parent),
        "HOME": str(folder),
        "OMP_NUM_THREADS": "1",
        "OPENBLAS_NUM_THREADS": "1",
    }
    with (folder / "said.txt").open("w+") as said:
        process = subprocess.Popen(command, cwd=folder, env=environment, stdout=said, stderr=said)
        deadline = time.monotonic() + PATIENCE
        while True:
            pid, status, used = os.wait4(process.pid, os.WNOHANG)
            if pid:
                break
            if time.monotonic() > deadline:
                process.kill()
                os.wait4(process.pid, 0)
                return f"no verdict after {PATIENCE} s", float(PATIENCE)
            time.sleep(0.05)
        process.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        words = said.read().strip().splitlines() or ["failed without a word"]
    return "" if process.returncode == 0 else words[-1], used.ru_utime + used.ru_stime
