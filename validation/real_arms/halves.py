"""Does the interval of a parameter from one half of the recordings hold the estimate of the other half?

python -m validation.real_arms.halves [--quick] [--data DIR]
"""

from __future__ import annotations

import argparse
import json
import math
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from validation.real_arms.arms import EMPS, TX40, UR10E
from validation.real_arms.joint_states import read_joint_states

from lagnet.diagnosis.diagnose import Diagnosis, diagnose
from lagnet.effects.catalogue import effect_named
from lagnet.models.files.loading import load_any
from lagnet.recordings.loading.load import load_recording
from lagnet.recordings.recording import Recording

HERE = Path(__file__).resolve().parent
Halves = tuple[Any, list[Recording], list[Recording]]
Parameters = dict[tuple[str, str, str], tuple[float, float, float]]


def cases(data: Path) -> dict[str, Callable[[], Halves]]:
    """Nominal model and the two halves of the recordings of each set."""

    def of(arm, first: list[str], second: list[str]) -> Halves:
        robot = load_any(data / arm.folder / arm.urdf)
        return robot, *([_read(data / f, robot, arm) for f in part] for part in (first, second))

    def cut(arm, file: str) -> Halves:
        robot = load_any(data / arm.folder / arm.urdf)
        return robot, *_cut(_read(data / file, robot, arm))

    def panda() -> Halves:
        robot = load_any("panda")
        return robot, *_cut(load_recording(data / "panda" / "fit.csv.gz", robot=robot))

    def ur10() -> Halves:
        robot = load_any("ur10")
        return robot, *_cut(read_joint_states(data / "bags" / "ur10_exciting_trajectory.db3", robot.joints))

    fits = [f"ur10e/fit_{k}.csv.gz" for k in range(4)]
    return {
        "emps": lambda: of(EMPS, ["emps/fit.csv.gz"], ["emps/holdout.csv.gz"]),
        "staubli_tx40": lambda: cut(TX40, "staubli_tx40/fit.csv.gz"),
        "ur10": ur10,
        "panda": panda,
        "ur10e": lambda: of(UR10E, fits[:2], fits[2:]),
        "loaded_0": lambda: cut(UR10E, "ur10e_loaded/loaded_0.csv.gz"),
        "loaded_1": lambda: cut(UR10E, "ur10e_loaded/loaded_1.csv.gz"),
    }


def _read(path: Path, robot: Any, arm: Any) -> Recording:
    return load_recording(path, robot=robot, torque_constant=arm.torque_constant)


def _cut(recording: Recording) -> tuple[list[Recording], list[Recording]]:
    edge = len(recording) // 2
    return [recording.rows(slice(0, edge))], [recording.rows(slice(edge, None))]


def parameters(result: Diagnosis) -> Parameters:
    """(value, low, high) by effect, joint and parameter, as far as the effect says it: a mass alone says no centre."""
    return {
        (e.effect, e.joint or "arm", p.name): (p.value, *p.ci95)
        for e in result.effects
        for p in e.parameters
        if p.name in effect_named(e.effect).told({q.name: q.value for q in e.parameters})
    }


def study(case: Halves) -> dict[str, Any]:
    """Every parameter that both halves name, and whether each interval holds the other half's estimate."""
    robot, first, second = case
    begun = time.perf_counter()
    found = [parameters(diagnose(half, robot)) for half in (first, second)]
    rows = []
    for key in sorted(found[0].keys() & found[1].keys()):
        (a, *of_a), (b, *of_b) = found[0][key], found[1][key]
        if of_a[0] == of_a[1] and of_b[0] == of_b[1]:
            continue  # a choice has no interval
        rows.append(
            {
                "parameter": list(key),
                "values": [a, b],
                "half_widths": [0.5 * (of_a[1] - of_a[0]), 0.5 * (of_b[1] - of_b[0])],
                "holds": [of_a[0] <= b <= of_a[1], of_b[0] <= a <= of_b[1]],
            }
        )
    alone = [sorted({"/".join(k[:2]) for k in x} - {"/".join(k[:2]) for k in y}) for x, y in (found, found[::-1])]
    return {"seconds": round(time.perf_counter() - begun, 1), "named_in_one_half": alone, "parameters": rows}


def summary(results: dict[str, Any]) -> dict[str, Any]:
    """Share of intervals that hold the other half's estimate; share of differences within √(a² + b²) of both widths."""
    held = {name: [h for p in r["parameters"] for h in p["holds"]] for name, r in results.items()}
    every = [h for part in held.values() for h in part]
    near = [_agree(p) for r in results.values() for p in r["parameters"]]
    by_arm = {name: {"intervals": len(h), "held": sum(h)} for name, h in held.items()}
    return {
        "intervals": len(every),
        "held": sum(every),
        "share": sum(every) / len(every),
        "differences_within_both_intervals": sum(near) / len(near),
        "by_arm": by_arm,
    }


def _agree(row: dict[str, Any]) -> bool:
    (a, b), widths = row["values"], row["half_widths"]
    return abs(a - b) <= math.hypot(*widths)


def main() -> None:
    """Runs the sets and writes halves.json; --quick: the first two, nothing written."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--data", type=Path, default=Path(os.environ.get("LAGNET_DATA_DIR", "../shared/data")))
    parser.add_argument("--only", nargs="*")
    args = parser.parse_args()
    every = cases(args.data)
    names = args.only or (list(every)[:2] if args.quick else list(every))
    results = {}
    for name in names:
        results[name] = study(every[name]())
        print(name, json.dumps(results[name], indent=1), flush=True)
    print(json.dumps(summary(results), indent=1))
    if not (args.quick or args.only):
        text = json.dumps({"summary": summary(results), "sets": results}, indent=1)
        (HERE / "halves.json").write_text(text + "\n")


if __name__ == "__main__":
    main()
