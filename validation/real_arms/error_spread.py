"""How much does the error of one correction differ between two stretches of motion of an arm that did not change?

A calibrated model knows the error that it left on held-out motion. On another motion the same model of the same arm
leaves another one: what a new recording shows beyond the known error by less than that is no change of the arm. Each
set and split is diagnosed, and the error of the full correction compared between the two halves of the held-out part;
nothing of the arm changed between them.

python -m validation.real_arms.error_spread [--data DIR] [--quick]
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from validation.real_arms.layers import BANDS, cases
from validation.real_arms.options import parser_of
from validation.real_arms.splits import splits

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.problem.problem import pose_problem
from lagnet.diagnosis.rules.lack_of_fit import LackOfFit
from lagnet.recordings.conditioning.condition import condition

HERE = Path(__file__).resolve().parent
QUANTILES = {"median": 0.5, "upper_quartile": 0.75, "upper_decile": 0.9}


def ratios(case: Any, name: str) -> list[float]:
    """Larger over smaller mean square error of the two halves of the held-out motion, by joint."""
    robot, fit_on, held = case
    model = diagnose(fit_on, robot, held, seed=0).corrected
    fit = condition(fit_on)
    problem = pose_problem(robot, fit, condition(held, BANDS.get(name, fit.bandwidth)))
    errors = np.concatenate(
        [problem.reduce(p, p.tau - model.torque_along(p.time, p.q, p.v, p.a)) for p in problem.holdout]
    )
    first, second = (np.mean(half**2, axis=0) for half in np.array_split(errors, 2))
    return [round(float(x), 3) for x in np.maximum(first / second, second / first)]


def main() -> int:
    """Run the study; 0 if the rule asks for at least the upper decile of these ratios."""
    options = parser_of(__doc__, "EMPS alone").parse_args()
    every = {**cases(options.data), **splits(options.data)}
    found: dict[str, list[float]] = {}
    for name in ["emps"] if options.quick else every:
        found[name] = ratios(every[name](), name.split(":")[0])
        print(name, found[name], flush=True)
    joints = [r for one in found.values() for r in one]
    quantiles = {name: round(float(np.quantile(joints, q)), 2) for name, q in QUANTILES.items()}
    told = {"joints": len(joints), "asked_by_lack_of_fit": LackOfFit().outgrows, **quantiles}
    if not options.quick:
        (HERE / "error_spread.json").write_text(json.dumps({"summary": told, "ratios": found}, indent=1) + "\n")
    print(told)
    return int(told["asked_by_lack_of_fit"] < told["upper_decile"])


if __name__ == "__main__":
    raise SystemExit(main())
