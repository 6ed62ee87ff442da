"""Does the diagnosis find the first set of effects, one and two at a time, and stay silent where nothing is hidden?

python -m validation.first_set.study [--quick | --score-again] [--seed 1] [--processes 2]
"""

from __future__ import annotations

import argparse
import json
import sys
from itertools import product
from pathlib import Path

from validation.plants.draw import FIRST_SET, draw_plant
from validation.plants.figures import draw
from validation.plants.protocol import Line, conduct, fresh, report
from validation.plants.scoring import score_again
from validation.plants.spec import PlantSpec

HERE = Path(__file__).resolve().parent
ROBOTS = ("ur5", "panda", "ur10")
LINES = (
    Line("recall", 0.95, at_least=True),
    Line("wrong_share", 0.05, at_least=False),
    Line("claims_on_plants_without_physics", 0, at_least=False),
    Line("median_parameter_error", 0.01, at_least=False),
    Line("median_gain_share", 0.95, at_least=True),
)


def plants(seed: int, quick: bool) -> list[PlantSpec]:
    """Every effect on every robot, twice; as many pairs as half of that; twenty with nothing hidden."""
    kinds = tuple(FIRST_SET)
    if quick:
        alone = [(kinds[i], ROBOTS[i % 3]) for i in (0, 5, 9)]
        pairs, nothing = 1, 1
    else:
        alone = list(product(kinds, ROBOTS)) * 2
        pairs, nothing = 36, 20
    specs = [draw_plant(seed, n, (kind,), 1, (robot,)) for n, (kind, robot) in enumerate(alone)]
    for _ in range(pairs):
        specs.append(draw_plant(seed, len(specs), kinds, 2, (ROBOTS[len(specs) % 3],)))
    for _ in range(nothing):
        specs.append(draw_plant(seed, len(specs), kinds, 0, (ROBOTS[len(specs) % 3],)))
    return specs


def score_kept() -> int:
    """Write result.json and figure again from the claims in it."""
    kept = json.loads((HERE / "result.json").read_text())
    passed = report([score_again(p) for p in kept["plants"]], LINES, kept["study"], HERE / "result.json")
    draw(HERE / "result.json", HERE / "figure.png")
    return 0 if passed else 1


def main() -> int:
    """Run the study; exit code 1 where a pass line is crossed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="a handful of plants, result in out/")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--score-again", action="store_true", help="judge the claims of result.json anew")
    given = parser.parse_args()
    if given.score_again:
        return score_kept()
    out = fresh(Path("out") / ("first_set_quick" if given.quick else "first_set"))
    scores = conduct(plants(given.seed, given.quick), out, given.processes)
    home = out if given.quick else HERE
    study = {"command": "python -m validation.first_set.study", "seed": given.seed, "quick": given.quick}
    passed = report(scores, LINES, study, home / "result.json")
    draw(home / "result.json", home / "figure.png")
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
