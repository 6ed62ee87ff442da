"""Delay, elasticity, backlash and dead band, each hidden in turn: is one ever told as another?

python -m validation.motion_concealed.confusions [--each 11] [--seed 31] [--kept FILE] [--out FILE]
"""

from __future__ import annotations

import argparse
import json
from collections import Counter
from collections.abc import Sequence
from itertools import chain, repeat
from pathlib import Path
from typing import Any

from lagnet.diagnosis.verdict.verdict import EffectFound
from validation.motion_concealed.causes import Cause
from validation.motion_concealed.study import HERE, LONG, MOST_TIED, run, scored, write_result

FOUR = ("command_delay", "joint_elasticity", "backlash", "dead_band")
KINDS = ("pendulum", "leg_bullet", "leg", "pendulum_bullet", "leg")
OUTCOMES = ("named right", "tied", "abstained", "named as another")


def outcome(
    plant_name: str, cause: Cause | None, joints: Sequence[str], effects: Sequence[EffectFound]
) -> dict[str, Any]:
    """The row of a plant with what became of its cause."""
    assert cause is not None
    at = [e for e in effects if e.joint == joints[cause.joint]]
    right = [e for e in at if cause.effect in (e.effect, *e.tied_with) and len(e.tied_with) < MOST_TIED]
    others = [e.effect for e in effects if e not in right]
    if others:
        told = "named as another"
    elif not right:
        told = "abstained"
    else:
        told = "named right" if right[0].effect == cause.effect and not right[0].tied_with else "tied"
    return scored(plant_name, cause, joints, effects) | {"outcome": told, "others": others}


def table(rows: Sequence[dict[str, Any]]) -> dict[str, dict[str, int]]:
    """How often each of the four was told right, tied, not at all, or as another."""
    counts = Counter((r["cause"]["effect"], r["outcome"]) for r in rows)
    return {effect: {o: counts[effect, o] for o in OUTCOMES} for effect in FOUR}


def result_of(seed: int, rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """What confusions.json holds."""
    found = table(rows)
    totals = {o.replace(" ", "_"): sum(found[effect][o] for effect in FOUR) for o in OUTCOMES}
    passed = {"never_one_for_another": totals["named_as_another"] == 0, "plants": len(rows) >= 40}
    study = "motion_concealed_confusions"
    return {"study": study, "seed": seed, "plants": len(rows), **totals, "table": found, "passed": passed} | {
        "cases": list(rows)
    }


def main() -> int:
    """Run the study; 0 if nothing is told as another."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--each", type=int, default=11, help="plants of each of the four")
    parser.add_argument("--seed", type=int, default=31)
    parser.add_argument("--kept", type=Path, help="file of a row a plant, from which an interrupted run goes on")
    parser.add_argument("--out", type=Path, default=HERE / "confusions.json", help="file of the result")
    options = parser.parse_args()
    plan = tuple(chain.from_iterable(repeat(effect, 2) for effect in FOUR))  # an encoder on either side
    plan = tuple(plan[i % len(plan)] for i in range(len(FOUR) * options.each))
    result = result_of(options.seed, run(plan, options.seed, LONG, KINDS, options.kept, outcome))
    write_result(options.out, result)
    summary = {key: value for key, value in result.items() if key != "cases"}
    write_result(HERE / "result.json", json.loads((HERE / "result.json").read_text("utf-8")) | {"confusions": summary})
    print(json.dumps(result["table"] | {"passed": result["passed"]}, indent=1))
    return 0 if all(result["passed"].values()) else 1


if __name__ == "__main__":
    raise SystemExit(main())
