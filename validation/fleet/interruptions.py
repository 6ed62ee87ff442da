"""Kills a worker, and the command itself, in the middle of a small fleet: the tables must be those of a run in peace.

python -m validation.fleet.interruptions [--robots N] [--recordings N]
"""

from __future__ import annotations

import argparse
import hashlib
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import psutil

from validation.fleet.generate import write_fleet

TABLES = ("track.parquet", "changes.parquet", "family.parquet")
FIRST = 3  # recordings finished before something is killed
LONGEST = 1800  # [s] of a command
ROBOTS, RECORDINGS, SEED = 6, 3, 7  # of the fleet; a make is calibrated on a robot of which nothing changes


def command(manifest: Path, out: Path) -> subprocess.Popen:
    """`lagnet track` with one worker, in a process group of its own."""
    words = [sys.executable, "-m", "lagnet.cli.main", "track", str(manifest), "--out", str(out), "--workers", "1"]
    return subprocess.Popen(words, start_new_session=True, stdout=subprocess.DEVNULL)


def finished(out: Path) -> int:
    """Recordings that are done."""
    return len(list(out.glob("diagnoses/*/*/tracked.json")))


def wait_for(process: subprocess.Popen, out: Path) -> bool:
    """Until some recordings are done; False if the command ended before."""
    while finished(out) < FIRST:
        if process.poll() is not None:
            return False
        time.sleep(0.05)
    return True


def workers_of(process: subprocess.Popen) -> list[psutil.Process]:
    """The processes that work: children of Dask's nannies, the busiest first."""
    children = psutil.Process(process.pid).children(recursive=True)
    spawned = [p for p in children if any("spawn_main" in word for word in p.cmdline())]
    return sorted(spawned, key=lambda p: -sum(p.cpu_times()[:2]))


def checksums(out: Path) -> tuple[str, ...]:
    """Of the tables."""
    return tuple(hashlib.sha256((out / name).read_bytes()).hexdigest() for name in TABLES)


def in_peace(manifest: Path, out: Path) -> tuple[str, ...]:
    """A run that nobody disturbs."""
    if command(manifest, out).wait(LONGEST) != 0:
        raise RuntimeError("the command failed")
    return checksums(out)


def worker_killed(manifest: Path, out: Path) -> tuple[str, ...]:
    """A run whose worker is killed."""
    process = command(manifest, out)
    if not wait_for(process, out):
        raise RuntimeError("the command ended before its worker could be killed: give more recordings")
    workers_of(process)[0].send_signal(signal.SIGKILL)
    print(f"worker killed after {finished(out)} recordings", flush=True)
    if process.wait(LONGEST) != 0:
        raise RuntimeError("the command failed")
    return checksums(out)


def command_killed(manifest: Path, out: Path) -> tuple[str, ...]:
    """A run that is killed with all its processes, and started again."""
    process = command(manifest, out)
    if not wait_for(process, out):
        raise RuntimeError("the command ended before it could be killed: give more recordings")
    os.killpg(process.pid, signal.SIGKILL)
    process.wait(LONGEST)
    print(f"command killed after {finished(out)} recordings", flush=True)
    kept = {p: p.stat().st_mtime_ns for p in out.glob("diagnoses/*/*/tracked.json")}
    sums = in_peace(manifest, out)
    if any(p.stat().st_mtime_ns != moment for p, moment in kept.items()):
        raise RuntimeError("a finished diagnosis was done again")
    return sums


def main() -> int:
    """0 if all three runs give the same tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robots", type=int, default=ROBOTS)
    parser.add_argument("--recordings", type=int, default=RECORDINGS)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        manifest = write_fleet(folder / "fleet", options.robots, options.recordings, SEED, "unusual")
        peace = in_peace(manifest, folder / "peace")
        runs = {
            "worker killed": worker_killed(manifest, folder / "worker"),
            "command killed and started again": command_killed(manifest, folder / "command"),
        }
    for name, sums in runs.items():
        print(f"{'met    ' if sums == peace else 'NOT MET'} {name}: the same tables as in peace")
    return 0 if all(sums == peace for sums in runs.values()) else 1


if __name__ == "__main__":
    raise SystemExit(main())
