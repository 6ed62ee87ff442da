"""Whole diagnoses of a few seconds: each quarter of the fitted recordings by itself, all else held out.

python -m validation.real_arms.short [--quick] [--data DIR]
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from validation.real_arms.layers import Case, cases
from validation.real_arms.options import parser_of
from validation.real_arms.whole import whole

from lagnet.errors import LagnetError
from lagnet.recordings.recording import Recording

HERE = Path(__file__).resolve().parent
SETS = ("staubli_tx40", "panda", "ur10", "loaded_0", "loaded_1")  # of one recording each
PARTS = 4
WAYS = ("nominal", "least_squares", "least_squares_and_trees", "named", "identified", "full")


def part_of(case: Case, number: int) -> Case:
    """One part of the fitted recording, and what is before and after it with the held-out ones."""
    robot, (fit,), held = case
    first, last = (int(len(fit) * k / PARTS) for k in (number, number + 1))
    others: list[Recording] = [fit.rows(slice(0, first))] if first else []
    others += [fit.rows(slice(last, None))] if last < len(fit) else []
    return robot, [fit.rows(slice(first, last))], [*others, *held]


def summary(found: dict[str, Any]) -> dict[str, Any]:
    """Geometric means over all joints of the errors over those of least squares, and joints far beyond these."""
    told = {name: one for name, one in found.items() if "nmse" in one}
    ratio = {
        way: np.concatenate([np.divide(one["nmse"][way], one["nmse"]["least_squares"]) for one in told.values()])
        for way in WAYS
    }
    joints = [f"{name}, joint {j + 1}" for name, one in told.items() for j in range(len(one["nmse"]["named"]))]
    return {
        "diagnoses": len(found),
        "refused": [name for name in found if name not in told],
        "without_a_name": [name for name, one in told.items() if not one["names"]],
        "names_median": float(np.median([one["names"] for one in told.values()])),
        "joints": len(joints),
        "over_least_squares": {way: round(float(np.exp(np.mean(np.log(r)))), 3) for way, r in ratio.items()},
        "identified_beyond_1.1": [j for j, r in zip(joints, ratio["identified"], strict=True) if r > 1.1],
    }


def main() -> int:
    """Run the study; 0 if nothing is refused or without a name, and no joint is beyond 1.1 times least squares."""
    options = parser_of(__doc__, "the TX40 alone").parse_args()
    every, found = cases(options.data), {}
    for name in SETS[:1] if options.quick else SETS:
        for number in range(PARTS):
            which = f"{name}, part {number + 1}"
            try:
                found[which] = whole(name, part_of(every[name](), number))
            except LagnetError as error:
                found[which] = {"refused": str(error)}
            print(which, json.dumps(found[which]), flush=True)
    told = summary(found)
    print(json.dumps(told, indent=1))
    if not options.quick:
        (HERE / "short.json").write_text(json.dumps({"summary": told, "found": found}, indent=1) + "\n")
    return 1 if told["refused"] or told["without_a_name"] or told["identified_beyond_1.1"] else 0


if __name__ == "__main__":
    raise SystemExit(main())
