"""One worker against two, memory of each, and what the scheduler costs.

python -m validation.workers.study [--quick]
"""

from __future__ import annotations

import argparse
import json
import os
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

import lagnet
from lagnet.tracking.engine import Engine, EngineSettings, open_engine
from lagnet.tracking.work import Work
from validation.workers.work import Spent, shares, tasks_of, timed

HERE = Path(__file__).resolve().parent
OVERHEAD, THROUGHPUT, MEMORY = 0.05, 1.8, 1.5e9
SMALL, QUICK_SMALL = 1000, 40  # diagnoses
TURNS, EACH = 4, 8  # pairs of turns, and searches in each turn
LARGE = 4  # searches of seven joints
BOUND = 4_000_000_000  # of a worker [bytes]: above the line, so that what it needs is seen


def done(engine: Engine, tasks: Sequence[Work]) -> tuple[float, list[Spent]]:
    """Wall time of tasks through an engine [s], and what each took.

    Raises:
        RuntimeError: one failed.
    """
    start, spent = time.perf_counter(), []
    for outcome in engine.run(timed, tasks):
        if outcome.error is not None:
            raise RuntimeError(outcome.error)
        spent.append(outcome.result)
    return time.perf_counter() - start, spent


def overhead(folder: Path, count: int) -> dict[str, Any]:
    """Small diagnoses through one worker, after some that load its modules."""
    tasks = tasks_of(folder, 2, 15.0, count + 10, "unusual")
    with open_engine(EngineSettings(workers=1, memory=BOUND)) as engine:
        done(engine, tasks[:10])
        wall, spent = done(engine, tasks[10:])
    work = sum(s.wall for s in spent)
    each = np.array([s.wall for s in spent])
    return {
        "diagnoses": count,
        "seconds": round(wall, 2),
        "seconds_in_diagnoses": round(work, 2),
        "median_diagnosis_s": round(float(np.median(each)), 4),
        "overhead": round(wall / work - 1.0, 4),
        "overhead_per_task_ms": round(1e3 * (wall - work) / count, 2),
    }


def throughput(folder: Path, turns: int) -> dict[str, Any]:
    """Full searches with one worker and with two, in turns, each with the same number of searches for each worker."""
    tasks = tasks_of(folder, 2, 15.0, 3 * (turns * EACH + 2), "every")
    first, rest = tasks[:6], tasks[6:]
    ratios, processor, core = [], [], []
    settings = [EngineSettings(workers=n, memory=BOUND) for n in (1, 2)]
    with open_engine(settings[0]) as one, open_engine(settings[1]) as two:
        done(one, first[:2])
        done(two, first[2:])
        for part in shares(rest, turns):
            alone, pair = done(one, part[:EACH]), done(two, part[EACH:])
            ratios.append((len(pair[1]) / pair[0]) / (len(alone[1]) / alone[0]))
            processor.append(np.mean([s.processor for s in pair[1]]) / np.mean([s.processor for s in alone[1]]))
            core.append([sum(s.processor for s in part) / sum(s.wall for s in part) for _, part in (alone, pair)])
    return {
        "turns": turns,
        "ratios": [round(float(r), 3) for r in ratios],
        "ratio": round(float(np.median(ratios)), 3),
        "share_of_a_core": [round(float(c), 3) for c in np.median(core, axis=0)],
        "processor_ratio": round(float(np.median(processor)), 3),
        "on_own_cores": round(2.0 / float(np.median(processor)), 3),
    }


def memory(folder: Path) -> dict[str, Any]:
    """Full searches of seven joints over a minute, two at a time."""
    tasks = tasks_of(folder, 7, 60.0, LARGE, "every")
    with open_engine(EngineSettings(workers=2, memory=BOUND)) as engine:
        _, spent = done(engine, tasks)
    return {
        "searches": LARGE,
        "median_seconds": round(float(np.median([s.wall for s in spent])), 1),
        "greatest_bytes": max(s.memory for s in spent),
    }


def judge(found: dict[str, Any]) -> list[dict[str, Any]]:
    """Pass lines."""
    small, pair = found["overhead"], found["throughput"]
    lines = [
        (f"overhead of the scheduler ≤ {OVERHEAD:.0%}", small["overhead"], small["overhead"] <= OVERHEAD),
        (f"two workers ≥ {THROUGHPUT} × one", pair["ratio"], pair["ratio"] >= THROUGHPUT),
    ]
    if "memory" in found:
        most = found["memory"]["greatest_bytes"]
        lines.append(("memory of a worker ≤ 1.5 GB", most, most <= MEMORY))
    return [{"claim": c, "found": f, "passed": bool(p)} for c, f, p in lines]


def main() -> int:
    """Run the study; 0 if every line is passed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="few diagnoses, no seven joints; writes nothing")
    quick = parser.parse_args().quick
    found: dict[str, Any] = {"cores": os.cpu_count(), "load_at_start": round(os.getloadavg()[0], 1)}
    with tempfile.TemporaryDirectory() as scratch:
        for name in ("small", "pair", "large"):
            (Path(scratch) / name).mkdir()
        found["overhead"] = overhead(Path(scratch) / "small", QUICK_SMALL if quick else SMALL)
        print(found["overhead"], flush=True)
        found["throughput"] = throughput(Path(scratch) / "pair", 1 if quick else TURNS)
        print(found["throughput"], flush=True)
        if not quick:
            found["memory"] = memory(Path(scratch) / "large")
            print(found["memory"], flush=True)
    lines = judge(found)
    for line in lines:
        print(f"{'met    ' if line['passed'] else 'NOT MET'} {line['claim']}: {line['found']}")
    passed = all(line["passed"] for line in lines)
    if not quick:
        result = {"study": "workers", "version": lagnet.__version__, "passed": passed, **found, "lines": lines}
        (HERE / "result.json").write_text(json.dumps(result, indent=1, ensure_ascii=False) + "\n")
    return 0 if passed else 1


if __name__ == "__main__":
    raise SystemExit(main())
