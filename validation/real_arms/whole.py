"""The layers that a whole diagnosis gives, names and all, beside least squares and boosted trees, on sets and splits.

python -m validation.real_arms.whole [--quick] [--data DIR]
"""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import Any

import numpy as np
from validation.real_arms.layers import BANDS, Case, cases, errors_of, study
from validation.real_arms.options import parser_of
from validation.real_arms.splits import splits, summary

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.problem.problem import pose_problem
from lagnet.errors import LagnetError
from lagnet.recordings.conditioning.condition import condition

HERE = Path(__file__).resolve().parent
LAYERS = ("named", "identified", "full")


def whole(name: str, case: Case) -> dict[str, Any]:
    """Held-out nMSE of each joint by least squares, least squares with trees, and the layers of a diagnosis."""
    robot, fit_on, held = case
    found = study(name, case)  # the same conditioning and the same baselines, and the layers without names
    nmse = {way: found["nmse"][way] for way in ("nominal", "least_squares", "least_squares_and_trees")}
    nmse["identified_without_names"] = found["nmse"]["identified"]
    start = time.process_time()
    result = diagnose(fit_on, robot, held, seed=0)
    seconds = time.process_time() - start
    fit = condition(fit_on)
    problem = pose_problem(robot, fit, condition(held, fit.bandwidth))
    for layer in LAYERS:
        model = result.corrected.with_layers(layer)
        errors, _ = errors_of(problem, lambda p, m=model: m.torque_along(p.time, p.q, p.v, p.a), BANDS.get(name, 5.0))
        nmse[layer] = [round(float(x), 5) for x in errors]
    return {
        "nmse": nmse,
        "in_the_place_of_the_names": result.corrected.instead is not None,
        "names": len(result.effects),
        "seconds_of_processor": round(seconds, 1),
    }


def main() -> int:
    """Run the study; 0 if no joint's identified layer is beyond 1.1 times least squares, nor full beyond 1.05."""
    options = parser_of(__doc__, "EMPS alone").parse_args()
    every = {**cases(options.data), **splits(options.data)}
    found: dict[str, Any] = {}
    for name in ["emps"] if options.quick else every:
        try:
            found[name] = whole(name.split(":")[0], every[name]())
        except LagnetError as error:
            found[name] = {"refused": str(error)}
        print(name, json.dumps(found[name]), flush=True)
    told = {
        part: summary({n: found[n] for n in names if n in found and "nmse" in found[n]})
        for part, names in (("sets", cases(options.data)), ("splits", splits(options.data)))
        if set(names) & set(found)
    }
    told["mean_of_joints"] = {
        name: {way: round(float(np.mean(values)), 5) for way, values in one["nmse"].items()}
        for name, one in found.items()
        if "nmse" in one
    }
    print(json.dumps(told, indent=1))
    if not options.quick:
        (HERE / "whole.json").write_text(json.dumps({"summary": told, "found": found}, indent=1) + "\n")
    parts = [told[part] for part in ("sets", "splits") if part in told]
    return 1 if any(part["identified_beyond_1.1"] or part["full_beyond_1.05"] for part in parts) else 0


if __name__ == "__main__":
    raise SystemExit(main())
