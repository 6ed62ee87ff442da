"""UR-5 with damping in PyBullet: torque and its conservative parts on unseen motion. See README.md."""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from lagnet.models.kinds import AugmentedSettings
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.robot import Robot, load_description
from lagnet.training.cores import let_jax_see_cores
from lagnet.training.settings import TrainingSettings
from lagnet.training.train import train
from validation.damped.data import Damping, damped_motion
from validation.equal_budget import SETTINGS, Trained, trained
from validation.ideal.figure import draw_figure
from validation.ideal.motion import MotionSettings
from validation.ideal.study import DISSIPATION, LIMITS
from validation.ideal.terms import median_errors, term_errors

HERE = Path(__file__).parent
IDEAL = HERE.parent / "ideal" / "result.json"
SAMPLES = 58_494  # as many as the paper's
IDEAL_CASES = {"together": DISSIPATION, "stages": "delan-ffnn"}  # how DeLaN-FFNN was trained there
TEST = MotionSettings(motions=3, segments=6)
TEST_SEED = 3000
SEEDS = 5
SECONDS = 15.0  # processor time of the steps of one training, the same for every model and variant
SHARE = {  # of the steps: these forms of ε cost more a sample
    "delan-ffnn": 0.75,
    "delan-ffnn, own motion": 0.75,
    "delan-ffnn, odd": 0.75,
}
OTHERS = ("delan", "delan-blackbox", "ffnn")
TOGETHER = TrainingSettings(penalty=0.0, separation="joint")
LONGER = "delan-ffnn, longer"
LONG_SEEDS = 5  # five minutes of both cores each
LONG = replace(TOGETHER, steps=16_000, batch=2048, learning_rate=2e-2)
MODELS: dict[str, tuple[str, Any, TrainingSettings]] = {
    "delan-ffnn": ("delan-ffnn", AugmentedSettings(form="body-drag"), TOGETHER),
    "delan-ffnn, own motion": ("delan-ffnn", AugmentedSettings(form="dissipation"), TOGETHER),
    "delan-ffnn, odd": ("delan-ffnn", AugmentedSettings(parity="odd"), TOGETHER),
    "delan-ffnn, penalised": ("delan-ffnn", AugmentedSettings(), TrainingSettings(penalty=1e-2, separation="joint")),
    "delan-ffnn, stages": ("delan-ffnn", AugmentedSettings(), TrainingSettings(separation="stages")),
    **{kind: (kind, SETTINGS.get(kind), TrainingSettings()) for kind in OTHERS},
}


def run(quick: bool, names: Sequence[str], known: dict[str, Any]) -> dict[str, Any]:
    """Train models and variants; conservative parts are judged against the rigid bodies without damping.

    Args:
        quick: a minute.
        names: what to train; known: results of others.
    """
    robot = load_description("ur5")
    data = damped_motion(robot, MotionSettings(motions=160), 0, 4000 if quick else SAMPLES, Damping())
    test = damped_motion(robot, TEST, TEST_SEED, None, Damping())
    models = dict(known)
    for name in names:
        seeds = 1 if quick else LONG_SEEDS if name == LONGER else SEEDS
        done = [told(_trained(name, data, seed, quick), robot, test) for seed in range(seeds)]
        models[name] = over_seeds(done)
        print(name, models[name]["median"], flush=True)
    return {"samples": len(data), "test_samples": len(test), "models": models, "passed": judge(models)}


def _trained(name: str, data: Recording, seed: int, quick: bool) -> Trained:
    """One training: of a part of the budget, or the longer one."""
    kind, settings, training = MODELS["delan-ffnn" if name == LONGER else name]
    given = {"seed": seed, "settings": settings, "joint_types": ("continuous",) * 6}
    if name != LONGER:
        return trained([data], kind, 0.3 if quick else SECONDS * SHARE.get(name, 1.0), training, **given)
    began = time.process_time()
    result = train([data], kind, training=LONG, **given)
    return Trained(result, round(time.process_time() - began, 1))


def over_seeds(found: list[dict[str, Any]]) -> dict[str, Any]:
    """Medians of what several trainings of a model gave, and all of it."""
    median = median_errors([f["errors"] for f in found])
    shares = np.median([f["residual_share"] for f in found], axis=0)
    return {"median": median, "residual_share": shares.tolist(), "seeds": found}


def told(done: Trained, robot: Robot, test: Recording) -> dict[str, Any]:
    """Errors of torque and of its conservative parts, the share of ε, and what the training took."""
    assert test.v is not None
    assert test.a is not None
    model, power = done.result.model, test.tau.var(axis=0)
    found = term_errors(model, robot, test)
    error = model.inverse_dynamics(test.q, test.v, test.a) - test.tau
    found["torque"] = ((error**2).mean(axis=0) / power).tolist()
    outside = model.residual_torque(test.q, test.v, test.a).var(axis=0) / power
    steps = done.result.stats["steps"]
    spent = {"cpu_seconds": done.cpu_seconds, "steps": steps, "epsilon_shares": done.result.stats.get("epsilon_shares")}
    return {"errors": found, "residual_share": outside.tolist(), **spent}


def judge(models: dict[str, Any]) -> dict[str, bool]:
    """The pass line of README.md."""
    torque = {name: models[name]["median"]["torque"] for name in (*OTHERS, "delan-ffnn")}
    best = [min(torque[name][j] for name in OTHERS) for j in range(len(torque["ffnn"]))]
    passed = {
        "lowest_on_every_joint": all(x < b for x, b in zip(torque["delan-ffnn"], best, strict=True)),
        "five_times_lower": 5 * sum(torque["delan-ffnn"]) <= min(sum(torque[name]) for name in OTHERS),
    }
    ours, ideal = models.get(LONGER, models["delan-ffnn"])["median"], json.loads(IDEAL.read_text())["models"]
    for term in ("inertial", "coriolis", "gravity"):
        for against, name in IDEAL_CASES.items():
            passed[f"{term}_within_3_of_ideal_{against}"] = _all_below(ours[term], ideal[name]["median"][term], 3.0)
        passed[f"{term}_within_limits_of_ideal"] = _all_below(ours[term], LIMITS[term], 1.0)
    return passed


def _all_below(found: Sequence[float | None], limits: Sequence[float | None], factor: float) -> bool:
    pairs = zip(found, limits, strict=True)
    return all(error <= factor * limit for error, limit in pairs if error is not None and limit is not None)


def main() -> None:
    """Write result.json and figure.png; in quick mode only print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="a minute, for CI: four models, hardly trained")
    parser.add_argument("--only", action="append", choices=(*MODELS, LONGER), help="train these, keep other results")
    options = parser.parse_args()
    let_jax_see_cores()
    kept = json.loads((HERE / "result.json").read_text())["models"] if options.only and not options.quick else {}
    names = ("delan-ffnn", *OTHERS) if options.quick else options.only or (*MODELS, LONGER)
    result = run(options.quick, names, kept)
    print(json.dumps(result["passed"], indent=2))
    if not options.quick:
        (HERE / "result.json").write_text(json.dumps(result, indent=2) + "\n")
        draw_figure(result["models"], HERE / "figure.png")


if __name__ == "__main__":
    main()
