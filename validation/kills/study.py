"""Interrupts diagnose, train and simulate at random moments, and looks at what stands under final names.

python -m validation.kills.study            # writes result.json
python -m validation.kills.study --quick    # six interruptions, writes nothing
"""

from __future__ import annotations

import argparse
import json
import os
import re
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict
from pathlib import Path

import numpy as np

from lagnet.cli.main import BAD_INPUT
from lagnet.files import finite_json, write_whole
from validation.kills.commands import Timing, diagnosis, finish, make_inputs, simulation, training
from validation.kills.interrupt import KINDS, Interruption
from validation.kills.standing import digests, final_files
from validation.kills.trial import Reference, Row, tried

SEED = 0
TRIALS = {"simulate": 15, "diagnose": 25, "train": 10}  # into an empty folder, and as many into a finished one
QUICK = {"simulate": 3, "diagnose": 3}
LATEST = 0.98  # of the uninterrupted time, at which a signal may come


class Moments:
    """Draws interruptions of one command: kinds in turn; every second signal in the time of writing.

    Args:
        timing: of the uninterrupted run.
        sizes: of the files that it writes [bytes].
        seed: of the draws.
    """

    def __init__(self, timing: Timing, sizes: Sequence[int], seed: tuple[int, ...]):
        self.timing, self.sizes, self.rng = timing, sizes, np.random.default_rng(seed)

    def draw(self, index: int) -> Callable[[float], Interruption]:
        """The kind that is this index's turn; with each call a new moment, within a share of the time."""
        kind, late = KINDS[index % len(KINDS)], bool(index // len(KINDS) % 2) and self.timing.writing > 0
        if kind == "full disk":
            return lambda _: Interruption(kind, largest=int(self.rng.integers(1, int(self.rng.choice(self.sizes)))))
        room = self.timing.writing if late else self.timing.whole
        return lambda share: Interruption(kind, float(self.rng.uniform(0.0, LATEST * room * share)), late)


def main() -> None:
    """Runs the study."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--only", nargs="+", choices=TRIALS, help="these commands; writes nothing")
    asked = parser.parse_args()
    trials = QUICK if asked.quick else {name: n for name, n in TRIALS.items() if name in (asked.only or TRIALS)}
    began = time.perf_counter()
    rows = study(trials, asked.workers, halves=not asked.quick)
    found = figures(rows) | {"minutes": round((time.perf_counter() - began) / 60, 1)}
    print(json.dumps(found, indent=1))
    if not (asked.quick or asked.only):
        text = finite_json({"figures": found, "rows": [without_places(asdict(row)) for row in rows]})
        write_whole(Path(__file__).with_name("result.json"), text)
    sys.exit(not all(row.faultless for row in rows))


def without_places(row: dict) -> dict:
    """A row whose tracebacks name files from the package on, not where this machine has them."""
    return {**row, "said": re.sub(r'File "/[^"]*/(src|site-packages)/', r'File "\1/', row["said"])}


def study(trials: dict[str, int], workers: int, halves: bool = True) -> list[Row]:
    """So many interruptions of each command, into an empty folder and into a finished one.

    Args:
        trials: number by command.
        workers: trials at a time.
        halves: both; False: simulate into an empty folder, diagnose into a finished one.
    """
    with tempfile.TemporaryDirectory() as name, ThreadPoolExecutor(workers) as pool:
        folder, jobs = Path(name), []
        make_inputs(folder)
        for command, count in trials.items():
            for into_finished in (False, True) if halves else (command != "simulate",):
                jobs += _jobs(folder, command, count, into_finished)
        rows = [job.result() for job in [pool.submit(_one, job) for job in jobs]]
    return rows


def _jobs(folder: Path, name: str, count: int, into_finished: bool) -> list[tuple]:
    """The trials of one command: what each needs."""
    reference, timing, sizes = _reference(folder, name, into_finished)
    print(f"{name}: {timing.whole:.1f} s, of which writing {timing.writing:.2f} s", flush=True)
    moments, lock = Moments(timing, sizes, (SEED, len(name), int(into_finished))), threading.Lock()
    place = folder / f"{name}_{'finished' if into_finished else 'empty'}"
    return [(reference, moments.draw(k), lock, place / str(k)) for k in range(count)]


def _one(job: tuple) -> Row:
    reference, draw, lock, folder = job

    def drawn(share: float) -> Interruption:
        with lock:
            return draw(share)

    row = tried(reference, drawn, folder, _contracts())
    print(f"{_words(row)}{'' if row.faultless else f'   FAULT {asdict(row)}'}", flush=True)
    return row


def _words(row: Row) -> str:
    where = "into a finished result" if row.into_finished else "into an empty folder"
    return f"{row.command:9} {row.kind:9} at {row.moment:9.9g} {where}"


def _reference(folder: Path, name: str, into_finished: bool) -> tuple[Reference, Timing, list[int]]:
    """Uninterrupted runs of a command: the one to interrupt, and another whose result is in the way."""
    one, other = {
        "simulate": (simulation(folder, 1), simulation(folder, 2)),
        "diagnose": (diagnosis(folder, (0, 1)), diagnosis(folder, (1, 2))),
        "train": (training(folder, 0), training(folder, 1)),
    }[name]
    new, old = folder / f"{name}_new", folder / f"{name}_old"
    timing = finish(one, new) if not new.exists() else None
    if into_finished:
        timing = finish(other, old)
        if name == "simulate":  # which refuses such a folder
            timing = finish(one, old, (BAD_INPUT,))
    assert timing is not None
    sizes = [path.stat().st_size for path in final_files(new).values()]
    reference = Reference(one, digests(new), old if into_finished else None)
    return reference, timing, sizes


def _contracts() -> Path | None:
    """Folder of check_outputs.py, beside that of the recordings; None where there is none."""
    given = os.environ.get("LAGNET_DATA_DIR")
    folder = Path(given).parent / "contracts" if given else None
    return folder if folder and folder.is_dir() else None


def figures(rows: Sequence[Row]) -> dict:
    """Counts over all interruptions."""
    trained = [row for row in rows if row.same_weights is not None]
    return {
        "interruptions": len(rows),
        "into_finished_results": sum(r.into_finished for r in rows),
        "by_command": dict(Counter(r.command for r in rows)),
        "by_kind": dict(Counter(r.kind for r in rows)),
        "with_half_written_files": sum(bool(r.half_written) for r in rows),
        "with_lost_files": sum(bool(r.lost) for r in rows),
        "with_files_of_two_runs": sum(r.mixed for r in rows),
        "with_promises_unkept": sum(bool(r.unkept) for r in rows),
        "ended_badly": sum(not r.clean for r in rows),
        "with_drafts_left_by_kill": sum(bool(r.drafts) and r.kind == "kill -9" for r in rows),
        "with_drafts_left_otherwise": sum(bool(r.drafts) and r.kind != "kill -9" for r in rows),
        "trainings_run_again": len(trained),
        "from_a_checkpoint": sum(bool(r.checkpoint) for r in trained),
        "to_the_same_weights": sum(bool(r.same_weights) for r in trained),
        "faultless": sum(r.faultless for r in rows),
    }


if __name__ == "__main__":
    main()
