"""The commands that are interrupted: a planar arm of two joints, short recordings, some seconds a run."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from lagnet.files import write_whole

ROBOT, EFFECTS, RUNS = "arm.urdf", "effects.toml", "runs"
TRAIN_STEPS = 800
PATIENCE = 300  # [s] after which a run counts as failed
POLL = 0.002  # [s]
LINK = """<link name="{name}"><inertial><origin xyz="{c} 0 0"/><mass value="{m}"/>
<inertia ixx="0.005" ixy="0" ixz="0" iyy="{i}" iyz="0" izz="{i}"/></inertial></link>
<joint name="{joint}" type="revolute"><parent link="{on}"/><child link="{name}"/><origin xyz="{at} 0 0"/>
<axis xyz="0 1 0"/><limit lower="-2.5" upper="2.5" velocity="3" effort="100"/></joint>
"""
VISCOUS = '[[effect]]\nname = "viscous_friction"\njoint = "shoulder"\nFv = 2.0\n'


@dataclass(frozen=True)
class Command:
    """One command of lagnet, less its output folder.

    Args:
        name: diagnose, train or simulate.
        words: its arguments, with paths relative to the folder of inputs.
        inputs: that folder.
    """

    name: str
    words: tuple[str, ...]
    inputs: Path

    def line(self, out: Path) -> list[str]:
        """The command line that writes into a folder."""
        return [sys.executable, "-m", "lagnet", self.name, *self.words, "--out", str(out)]


def environment() -> dict[str, str]:
    """One thread a process, so that the same command gives the same bytes."""
    return os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def make_inputs(folder: Path) -> None:
    """Writes the arm, an effects file and three recordings of 4 s at 100 Hz."""
    upper = LINK.format(name="upper", joint="shoulder", on="base", at=0, c=0.2, m=3, i=0.05)
    lower = LINK.format(name="lower", joint="elbow", on="upper", at=0.4, c=0.15, m=2, i=0.02)
    write_whole(folder / ROBOT, f'<robot name="planar"><link name="base"/>{upper}{lower}</robot>')
    write_whole(folder / EFFECTS, VISCOUS)
    finish(simulation(folder, seed=0, trajectories=3), folder / RUNS)


def simulation(folder: Path, seed: int, trajectories: int = 2) -> Command:
    """`lagnet simulate` of that arm."""
    words = ("--robot", ROBOT, "--effects", EFFECTS, "--seed", str(seed), "--duration", "4")
    return Command("simulate", (*words, "--trajectories", str(trajectories)), folder)


def diagnosis(folder: Path, recordings: Sequence[int]) -> Command:
    """`lagnet diagnose` of some of the recordings."""
    return Command("diagnose", (*_runs(recordings), "--robot", ROBOT), folder)


def training(folder: Path, seed: int) -> Command:
    """`lagnet train` of a network on two recordings."""
    words = ("--model", "ffnn", "--steps", str(TRAIN_STEPS), "--seed", str(seed), "--cores", "1")
    return Command("train", (*_runs((0, 1)), *words), folder)


def _runs(indices: Sequence[int]) -> tuple[str, ...]:
    return tuple(f"{RUNS}/trajectory_{k}.csv" for k in indices)


@dataclass(frozen=True)
class Timing:
    """Of an uninterrupted run: its wall time, and how much of it follows the first change in the output folder [s]."""

    whole: float
    writing: float


def finish(command: Command, out: Path, codes: tuple[int, ...] = (0,)) -> Timing:
    """Runs a command to its end.

    Raises:
        RuntimeError: it ended with none of the codes; its last words.
    """
    began = time.perf_counter()
    before, changed = stamp(out), None
    with subprocess.Popen(
        command.line(out),
        cwd=command.inputs,
        env=environment(),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        while process.poll() is None and time.perf_counter() - began < PATIENCE:
            changed = changed or (time.perf_counter() if stamp(out) != before else None)
            time.sleep(POLL)
        process.kill()
        said = process.communicate()[1]
    ended = time.perf_counter()
    if process.returncode not in codes:
        raise RuntimeError(f"{command.name}: exit code {process.returncode}: {said.strip()[-500:]}")
    return Timing(ended - began, ended - (changed or ended))


def stamp(folder: Path) -> tuple:
    """Changes with every file and draft in a folder; empty where there is none."""
    try:
        return (folder.stat().st_mtime_ns, *sorted(path.stat().st_mtime_ns for path in folder.iterdir()))
    except FileNotFoundError:
        return ()
