"""How small may an effect be and still be found, against noise and length of recording?

python -m validation.detection_limits.study [--quick] [--plants 6] [--seed 1] [--out out/detection_limits]
Finished plants are kept in the folder; the same command goes on where it stopped. Plants that another source code of
lagnet diagnosed are not taken up.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Sequence
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path

from validation.concealed.code import fingerprint
from validation.detection_limits.curves import limits
from validation.detection_limits.picture import draw
from validation.detection_limits.plants import ROBOTS, SHAPES, plan_of, set_up
from validation.detection_limits.staircase import CONDITIONS, MIDDLE, Trial, is_middle, next_size, try_plant
from validation.plants.catalogue.listed import LISTED, PASSING

HERE = Path(__file__).resolve().parent
QUICK_KINDS, QUICK_PLANTS = ("coulomb_friction", "joint_spring"), 2
CODE = fingerprint()  # of the source as it is when the study starts


def trials_of(kind: str, seed: int, number: int, size: float, file: Path) -> list[Trial]:
    """Trials of one plant, kept in a file; none where no such plant can be built."""
    if not file.exists():
        began = time.process_time()
        plan = plan_of(kind, seed, number, size)
        trials = [] if plan is None else _tried(set_up(plan), number, kind not in PASSING)
        content = {"trials": [asdict(t) for t in trials], "processor_seconds": time.process_time() - began}
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps(content))
    return [Trial(**t) for t in json.loads(file.read_text())["trials"]]


def _tried(bench, number: int, shorter: bool) -> list[Trial]:
    return try_plant(bench.found, number, bench.plan.hidden[0].size, shorter)


def curve(kind: str, seed: int, count: int, folder: Path) -> dict:
    """All trials of one effect, and its limits by condition."""
    trials: list[Trial] = []
    for number in range(count):
        size = next_size([t for t in trials if is_middle(t)])
        trials += trials_of(kind, seed, number, size, folder / f"{kind}_{number}.json")
    conditions = [c for c in CONDITIONS if kind not in PASSING or c.duration == MIDDLE.duration]
    answers = "".join("x" if t.found else "." for t in trials if is_middle(t))
    print(kind, answers, flush=True)
    return {"effect": kind, "limits": limits(trials, conditions), "trials": [asdict(t) for t in trials]}


def content_of(curves: Sequence[dict], seed: int, count: int) -> dict:
    """What the result file holds."""
    study = {"command": "python -m validation.detection_limits.study", "seed": seed, "plants_of_an_effect": count}
    return {
        "study": study | {"robots": ROBOTS, "shapes": SHAPES},
        "versions": {"lagnet": version("lagnet"), "pin": version("pin")},
        "code": CODE,
        "curves": curves,
    }


def main() -> int:
    """Run; always 0: limits are reported, not judged."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="two effects, two plants each, result in out/")
    parser.add_argument("--plants", type=int, default=6, help="for each effect")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=Path("out") / "detection_limits")
    given = parser.parse_args()
    kinds, count = (QUICK_KINDS, QUICK_PLANTS) if given.quick else (tuple(LISTED), given.plants)
    folder = given.out / CODE[:12] / f"seed_{given.seed}"
    found = [curve(kind, given.seed, count, folder) for kind in kinds]
    home = given.out if given.quick else HERE
    (home / "result.json").write_text(json.dumps(content_of(found, given.seed, count), indent=1) + "\n")
    draw(home / "result.json", home / "figure.png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
