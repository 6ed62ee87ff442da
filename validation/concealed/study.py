"""Seal, simulate, diagnose blindly, hash, open, score: the concealment protocol over all robots.

python -m validation.concealed.study [--quick | --plants 300] [--seed 2] [--processes 2]
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from validation.plants.draw import FIRST_SET, ROBOTS, draw_plant
from validation.plants.figures import draw
from validation.plants.protocol import Line, conduct, fresh, report
from validation.plants.spec import PlantSpec

HERE = Path(__file__).resolve().parent
FULL, QUICK = 300, 5
LINES = (
    Line("precision", 0.97, at_least=True),
    Line("recall", 0.92, at_least=True),
    Line("right_joint", 0.97, at_least=True),
    Line("claims_on_plants_without_physics", 1, at_least=False),
    Line("median_parameter_error", 0.03, at_least=False),
    Line("interval_coverage", 0.90, at_least=True),
    Line("median_gain_share", 0.95, at_least=True),
    Line("median_seconds", 30.0, at_least=False),
)


def plants(seed: int, count: int) -> list[PlantSpec]:
    """So many plants with one or two effects hidden, in turn, and a fifth as many with none."""
    kinds = tuple(FIRST_SET)
    specs = [draw_plant(seed, n, kinds, 1 + n % 2, ROBOTS) for n in range(count)]
    return specs + [draw_plant(seed, count + n, kinds, 0, ROBOTS) for n in range(max(1, count // 5))]


def main() -> int:
    """Run the protocol; exit code 1 where a pass line is crossed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="a handful of plants, result in out/")
    parser.add_argument("--plants", type=int, default=FULL, help="plants with something hidden")
    parser.add_argument("--seed", type=int, default=2)
    parser.add_argument("--processes", type=int, default=2)
    given = parser.parse_args()
    out = fresh(Path("out") / ("concealed_quick" if given.quick else "concealed"))
    count = QUICK if given.quick else given.plants
    scores = conduct(plants(given.seed, count), out, given.processes)
    home = HERE if count == FULL else out
    study = {"command": "python -m validation.concealed.study", "seed": given.seed, "plants": count}
    passed = report(scores, LINES, study, home / "result.json")
    draw(home / "result.json", home / "figure.png")
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
