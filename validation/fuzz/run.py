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
from lagnet.simulation.effects_file import read_effects
from validation.fuzz.mutate import mutated
from validation.fuzz.seeds import write_seeds

PATIENCE = 10  # [s] for one input
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
        "robot": load_any,
        "model": lambda path: load_any(path.parent),
    }
    assert lagnet.models.files.saving.FORMAT
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        seeds = write_seeds(folder)
        broken = folder / "broken"
        for _ in range(count):
            kind = list(seeds)[int(rng.integers(len(seeds)))]
            path = seeds[kind][int(rng.integers(len(seeds[kind])))]
            shutil.rmtree(broken, ignore_errors=True)
            if kind == "model":
                shutil.copytree(path.parent, broken)
            broken.mkdir(exist_ok=True)
            target = broken / path.name
            target.write_bytes(mutated(path.read_bytes(), rng))
            _give(readers[kind], target, tally)
    return tally


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
