"""How small may an effect be and still be found, against noise and length of recording?

python -m validation.detection_limits.study [--quick] [--trials 6] [--seed 1] [--processes 1] [--out DIR]
Finished curves are kept in DIR; the same command goes on where it stopped.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, replace
from importlib.metadata import version
from itertools import product
from multiprocessing import get_context
from pathlib import Path

import numpy as np

import lagnet
from validation.concealed.fair_names import claims_of, match
from validation.detection_limits.picture import draw
from validation.detection_limits.staircase import Trial, climb, limits
from validation.plants.catalogue.draw_plan import draw_hidden
from validation.plants.catalogue.listed import LISTED
from validation.plants.catalogue.plan import Plan
from validation.plants.catalogue.simulate import simulate

HERE = Path(__file__).resolve().parent
ROBOTS = ("ur5", "panda", "z1")
SHAPES = ("waypoints", "fourier", "sweeps", "fourier")
QUICK_KINDS = ("coulomb_friction", "joint_spring", "torque_offset")


@dataclass(frozen=True)
class Condition:
    """Noise over the torque's rms [–], and length of each of three recordings [s]."""

    noise: float
    duration: float


CONDITIONS = (Condition(0.005, 20.0), Condition(0.01, 20.0), Condition(0.02, 20.0), Condition(0.01, 8.0))


def plan_of(kind: str, condition: Condition, seed: int, number: int, size: float) -> Plan | None:
    """A plant that hides one cause of a size; None where none of that size can be built."""
    rng = np.random.default_rng([seed, number, *kind.encode()])
    frame = Plan(
        number=number,
        seed=int(rng.integers(2**31)),
        group="detection",
        robot=ROBOTS[number % len(ROBOTS)],
        hidden=(),
        noise=condition.noise,
        encoder_bits=20,
        angle_noise=0.0,
        current_filter=0.0,
        velocity=False,
        controller="computed_torque",
        engine="pinocchio",
        shapes=SHAPES,
        speed_share=0.7,
        duration=condition.duration,
    )
    hidden = draw_hidden(frame, kind, rng, size=size, least=0.0)
    return None if hidden is None else replace(frame, hidden=(hidden,))


def attempt(kind: str, condition: Condition, seed: int, number: int, size: float) -> Trial | None:
    """Simulate and diagnose one plant."""
    plan = plan_of(kind, condition, seed, number, size)
    if plan is None:
        return None
    with tempfile.TemporaryDirectory() as folder:
        witness, _ = simulate(plan, Path(folder))
        robot = lagnet.load_robot(plan.robot)
        runs = [lagnet.load_recording(str(Path(folder) / f"{n}.csv"), robot=robot) for n in plan.recordings]
        verdict = lagnet.diagnose(runs[:-1], robot=robot, holdout=runs[-1:]).verdict.to_dict()
    return Trial(plan.hidden[0].size, bool(match(plan, witness, claims_of(verdict))))


def curve(kind: str, condition: Condition, seed: int, count: int) -> dict:
    """Trials and limits of one effect under one condition."""
    trials = climb(lambda number, size: attempt(kind, condition, seed, number, size), count)
    return {"effect": kind, **asdict(condition), "trials": [asdict(t) for t in trials], **limits(trials)}


def curves(kinds: tuple[str, ...], conditions: tuple[Condition, ...], given: argparse.Namespace) -> Iterator[dict]:
    """All curves; those that lie in the folder are read."""
    tasks = []
    context = get_context("spawn")
    with ProcessPoolExecutor(given.processes, mp_context=context) as pool:
        for condition, kind in product(conditions, kinds):
            name = f"{kind}_{condition.noise:g}_{condition.duration:g}_{given.seed}_{given.trials}.json"
            kept = given.out / name
            task = None if kept.exists() else pool.submit(curve, kind, condition, given.seed, given.trials)
            tasks.append((kept, task))
        for kept, task in tasks:
            if task is not None:
                kept.write_text(json.dumps(task.result()))
                print(kept.stem, flush=True)
            yield json.loads(kept.read_text())


def main() -> int:
    """Run; always 0: limits are reported, not judged."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="three effects under one condition, result in out/")
    parser.add_argument("--trials", type=int, default=6, help="plants for each curve")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--out", type=Path, default=Path("out") / "detection_limits")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    kinds, conditions = tuple(LISTED), CONDITIONS
    if given.quick:
        kinds, conditions, given.trials = QUICK_KINDS, CONDITIONS[1:2], 4
    found = list(curves(kinds, conditions, given))
    home = given.out if given.quick else HERE
    content = {
        "study": {
            "command": "python -m validation.detection_limits.study",
            "seed": given.seed,
            "trials": given.trials,
            "robots": ROBOTS,
            "shapes": SHAPES,
        },
        "versions": {"lagnet": version("lagnet"), "pin": version("pin")},
        "curves": found,
    }
    (home / "result.json").write_text(json.dumps(content, indent=1) + "\n")
    draw(home / "result.json", home / "figure.png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
