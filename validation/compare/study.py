"""Parameter sets of one robot against recordings: simulated ones with a known truth, real ones against themselves.

python -m validation.compare.study [--quick] [--seed N]
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from pathlib import Path
from typing import Any

from validation.compare.real import cases
from validation.compare.simulated import CLEAR, Graded, motion_case, torque_case

HERE = Path(__file__).resolve().parent
TORQUE, MOTION, QUICK, SEED = 24, 12, 2, 300
WRONG, DECIDED, COVERED = 0.02, 0.9, 0.85


def summary(graded: list[Graded]) -> dict[str, Any]:
    """Counts over the joints and parameters of some cases."""
    rows = [row for g in graded for row in zip(g.ratio, g.said, g.baseline, strict=True)]
    clear = [said for ratio, said, _ in rows if ratio >= CLEAR]
    covered, agrees = [c for g in graded for c in g.covered], [a for g in graded for a in g.agrees]
    out = {name: sum(said == name for _, said, _ in rows) for name in ("right", "wrong", "undecided")}
    return {
        "joints": len(rows),
        **out,
        "clear": len(clear),
        "clear_and_decided": sum(said != "undecided" for said in clear),
        "baseline_wrong": sum(base == "wrong" for *_, base in rows),
        "parameters": len(covered),
        "interval_holds_truth": sum(covered),
        "named_set": len(agrees),
        "named_set_is_nearest": sum(agrees),
    }


def judge(found: dict[str, Any]) -> list[tuple[str, float, bool]]:
    """Pass lines, fixed before the first run."""
    out = []
    for route in ("torque", "motion"):
        s = found[route]
        wrong, decided = s["wrong"] / s["joints"], s["clear_and_decided"] / max(s["clear"], 1)
        held = s["interval_holds_truth"] / max(s["parameters"], 1)
        out.append((f"{route}: joints decided wrongly <= {WRONG:.0%}", wrong, wrong <= WRONG))
        out.append((f"{route}: joints that differ clearly decided >= {DECIDED:.0%}", decided, decided >= DECIDED))
        out.append((f"{route}: 95 % intervals that hold the truth >= {COVERED:.0%}", held, held >= COVERED))
    contradicted = sum(case["contradicted"] for case in found["real"])
    out.append(("real: decisions that other recordings contradict: 0", contradicted, contradicted == 0))
    return out


def main() -> int:
    """Run, judge, write."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--seed", type=int, default=SEED)
    options = parser.parse_args()
    counts = (QUICK, QUICK) if options.quick else (TORQUE, MOTION)
    found: dict[str, Any] = {"seed": options.seed}
    for route, case, count in (("torque", torque_case, counts[0]), ("motion", motion_case, counts[1])):
        found[route] = summary([case(options.seed + k) for k in range(count)])
        print(route, found[route], flush=True)
    data = Path(os.environ.get("LAGNET_DATA_DIR", HERE.parents[2] / "shared" / "data"))
    found["real"] = cases(data, options.quick) if data.is_dir() else []
    for case in found["real"]:
        print(case["robot"], *(f"\n  {joint}" for joint in case["joints"]), flush=True)
    lines = judge(found)
    found["lines"] = [{"line": name, "value": value, "passed": passed} for name, value, passed in lines]
    for name, value, passed in lines:
        print(f"{'holds' if passed else 'MISSED'}: {name}: {value:.3g}")
    if not options.quick:
        (HERE / "result.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    return 0 if all(passed for *_, passed in lines) else 1


if __name__ == "__main__":
    sys.exit(main())
