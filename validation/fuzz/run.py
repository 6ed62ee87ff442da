"""Gives broken inputs to the readers of lagnet and keeps what did not end in a result or in one clear line."""

from __future__ import annotations

import shutil
import signal
import tempfile
import time
import traceback
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

import lagnet.models.files.saving  # JAX is imported before the clock of the first model runs
from lagnet.errors import LagnetError
from lagnet.models.files.loading import load_any
from lagnet.recordings.loading.column_map import read_column_map
from lagnet.recordings.loading.load import load_recording
from lagnet.recordings.quality.screen import screen
from lagnet.rigid_body.robot import load_description
from lagnet.servos.servo_file import read_servo_file
from lagnet.simulation.effects_file import read_effects
from lagnet.tracking.manifest import read_manifest
from validation.fuzz.mutate import mutated
from validation.fuzz.seeds import Seed, write_seeds

PATIENCE = 10  # [s] for one input
WEIGHTS = {  # of the kinds of input
    **{"recording": 0.3, "log": 0.2, "robot": 0.15, "model": 0.15},
    **{"map": 0.05, "effects": 0.05, "servo": 0.05, "manifest": 0.05},
}
LONGEST_LINE = 20_000  # characters of a message


@dataclass
class Tally:
    """What came of the inputs."""

    inputs: int = 0
    accepted: int = 0
    refused: int = 0
    slowest_s: float = 0.0
    faults: list[str] = field(default_factory=list)


def fuzz(count: int, seed: int, tally: Tally | None = None) -> Tally:
    """So many broken inputs, drawn by a seed."""
    tally, rng, robot = tally or Tally(), np.random.default_rng(seed), load_description("ur5")
    readers: dict[str, Callable[[Path], Any]] = {
        "recording": lambda path: screen(load_recording(path)),
        "map": read_column_map,
        "effects": lambda path: read_effects(path, robot),
        "servo": lambda path: read_servo_file(path, robot.joints, robot.armature),
        "manifest": read_manifest,
        "robot": load_any,
        "model": load_any,
        "log": lambda path: screen(load_recording(path)),
    }
    assert lagnet.models.files.saving.FORMAT
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        seeds = write_seeds(folder)
        broken = folder / "broken"
        for _ in range(count):
            kind = str(rng.choice(list(WEIGHTS), p=list(WEIGHTS.values())))
            seed_file = seeds[kind][int(rng.integers(len(seeds[kind])))]
            shutil.rmtree(broken, ignore_errors=True)
            _give(readers[kind], _broken(seed_file, broken, rng), tally)
    return tally


def _broken(seed: Seed, folder: Path, rng: np.random.Generator) -> Path:
    """The copy of an input of which one file is broken."""
    given = folder / seed.read.name
    if seed.read.is_dir():
        shutil.copytree(seed.read, given)
    given.parent.mkdir(exist_ok=True)
    target = folder / seed.changed.relative_to(seed.read.parent)
    target.write_bytes(mutated(seed.changed.read_bytes(), rng))
    return given


def _give(read: Callable[[Path], Any], target: Path, tally: Tally) -> None:
    began = time.perf_counter()
    tally.inputs += 1
    signal.signal(signal.SIGALRM, _too_long)
    signal.alarm(PATIENCE)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            read(target)
        tally.accepted += 1
    except LagnetError as error:
        tally.refused += 1
        if len(str(error)) > LONGEST_LINE:
            tally.faults.append(f"{target.name}: a message of {len(str(error))} characters")
    except Exception:
        tally.faults.append(f"{target.name}: {traceback.format_exc().strip().splitlines()[-1][:200]} {_where()}")
    finally:
        signal.alarm(0)
    tally.slowest_s = max(tally.slowest_s, time.perf_counter() - began)


def _where() -> str:
    lines = [line.strip() for line in traceback.format_exc().splitlines() if "lagnet" in line and "File" in line]
    return lines[-1][-120:] if lines else ""


def _too_long(*_: object) -> None:
    raise TimeoutError(f"took longer than {PATIENCE} s")
