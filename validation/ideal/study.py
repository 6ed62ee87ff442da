"""UR-5 without left-out physics: which model finds torque and its parts on unseen motion? See README.md."""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

from lagnet.rigid_body.robot import load_description
from lagnet.training.settings import TrainingSettings
from lagnet.training.train import train
from validation.ideal.figure import draw_figure
from validation.ideal.motion import MotionSettings, random_motion
from validation.ideal.terms import median_errors, term_errors

HERE = Path(__file__).parent
SAMPLES = 60_667  # as many as the paper's
TEST = MotionSettings(motions=3, segments=10, rate=100.0)
LIMITS = {  # per joint, the pass line of README.md for the structured DeLaN
    "torque": [3e-4, 3e-4, 3e-4, 5e-3, 5e-3, 3e-2],
    "inertial": [3e-4, 3e-4, 3e-4, 5e-3, 5e-3, 3e-2],
    "coriolis": [1e-3, 1e-3, 1e-3, 5e-2, 5e-2, 5e-2],
    "gravity": [1e-4, 1e-4, 1e-4, 1e-2, 1e-2, 1e-2],
}
MASS_LIMIT = 1e-2
PLAN = {  # seeds and training of each model; the paper's perceptron form gets the longest
    "delan": (5, TrainingSettings(steps=5000, minutes=3.0)),
    "delan-ffnn": (1, TrainingSettings(steps=5000, minutes=4.0, penalty=1e-4)),
    "delan-perceptron": (1, TrainingSettings(steps=20000, minutes=4.0, learning_rate=3e-3)),
    "delan-blackbox": (1, TrainingSettings(steps=20000, minutes=3.0, learning_rate=3e-3)),
    "ffnn": (1, TrainingSettings(steps=20000, minutes=2.0, learning_rate=3e-3)),
}
ORDER = ("delan", "delan-ffnn", "delan-perceptron", "delan-blackbox", "ffnn")


def run(quick: bool) -> dict[str, Any]:
    """Train every model, judge it on motions of unseen seeds."""
    robot = load_description("ur5")
    data = random_motion(robot, MotionSettings(), seed=0, samples=6000 if quick else SAMPLES)
    test = random_motion(robot, TEST, seed=1000)
    models: dict[str, Any] = {}
    for kind, (seeds, training) in PLAN.items():
        training = replace(training, steps=200) if quick else training
        found, seconds, epsilon = [], [], []
        for seed in range(1 if quick else seeds):
            fit = train([data], kind, seed=seed, training=training, joint_types=("continuous",) * 6)
            found.append(term_errors(fit.model, robot, test))
            seconds.append(fit.stats["seconds"])
            residual = fit.model.residual_torque(test.q, test.v, test.a)
            epsilon.append(float((residual.var(axis=0) / test.tau.var(axis=0)).mean()))
            print(kind, seed, seconds[-1], found[-1], flush=True)
        models[kind] = {"median": median_errors(found), "seeds": found, "seconds": seconds, "residual_share": epsilon}
    return {"samples": len(data), "test_samples": len(test), "models": models, "passed": judge(models)}


def judge(models: dict[str, Any]) -> dict[str, bool]:
    """The pass line of README.md."""
    delan = models["delan"]["median"]
    within = {
        term: all(e is None or e <= limit for e, limit in zip(delan[term], limits, strict=True))
        for term, limits in LIMITS.items()
    }
    torque = {kind: _mean(models[kind]["median"]["torque"]) for kind in ORDER}
    return {
        **within,
        "mass_matrix": delan["mass_matrix"] <= MASS_LIMIT and delan["smallest_eigenvalue"] > 0,
        "in_15_minutes": max(models["delan"]["seconds"]) <= 900,
        "delan_ffnn_within_1.5_of_delan": torque["delan-ffnn"] <= 1.5 * torque["delan"],
        "epsilon_below_1e-3": max(models["delan-ffnn"]["residual_share"]) < 1e-3,
        "order_as_in_the_paper": torque["delan"] < torque["delan-blackbox"] < torque["ffnn"]
        and torque["delan-ffnn"] < torque["delan-blackbox"],
    }


def _mean(values: list[float | None]) -> float:
    kept = [x for x in values if x is not None]
    return sum(kept) / len(kept)


def main() -> None:
    """Write result.json and figure.png; in quick mode only print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="a minute, for CI: runs everything, proves nothing")
    quick = parser.parse_args().quick
    result = run(quick)
    print(json.dumps(result["passed"], indent=2))
    if not quick:
        (HERE / "result.json").write_text(json.dumps(result, indent=2) + "\n")
        draw_figure(result["models"], HERE / "figure.png")


if __name__ == "__main__":
    main()
