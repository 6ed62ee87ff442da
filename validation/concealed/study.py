"""Seal, simulate, diagnose blindly, hash, open, score: the concealment protocol over the whole catalogue.

python -m validation.concealed.study [--plants 360] [--seed 5] [--processes 2] [--out out/concealed] [--score-only]
A stopped run goes on when the same command is given again.
"""

from __future__ import annotations

import argparse
import json
import platform
import sys
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from importlib.metadata import version
from pathlib import Path

from validation.concealed.pictures import draw as draw_picture
from validation.concealed.protocol import Disturbance, OtherPlants, Run, draw, publish_seals
from validation.concealed.scoring import Score, read_scores
from validation.concealed.summary import by, by_effect, confusion, figures, misses

HERE = Path(__file__).resolve().parent
FULL, QUICK = 360, 6


@dataclass(frozen=True)
class Line:
    """One line that a figure must not cross; a figure that is missing crosses it."""

    figure: str
    limit: float
    at_least: bool

    def kept(self, all_figures: dict) -> bool:
        """Whether the figure keeps the line."""
        value = all_figures[self.figure]
        return value is not None and (value >= self.limit if self.at_least else value <= self.limit)


LINES = (
    Line("precision", 0.97, at_least=True),
    Line("recall", 0.92, at_least=True),
    Line("right_joint", 0.97, at_least=True),
    Line("claims_on_plants_with_nothing_hidden", 1, at_least=False),
    Line("unlisted_given_a_wrong_name", 0.05, at_least=False),
    Line("median_parameter_error", 0.03, at_least=False),
    Line("interval_coverage", 0.90, at_least=True),
    Line("interval_coverage", 0.99, at_least=False),
    Line("median_gain_share", 0.95, at_least=True),
    Line("median_processor_seconds", 30.0, at_least=False),
)


def report(scores: Sequence[Score], study: dict, path: Path) -> bool:
    """Write result.json and print the lines; whether every one was kept and every plant has a verdict."""
    found = figures(scores)
    kept = [line.kept(found) for line in LINES]
    content = {
        "study": study,
        "versions": {
            "lagnet": version("lagnet"),
            "pybullet": version("pybullet"),
            "pin": version("pin"),
            "python": platform.python_version(),
        },
        "pass_lines": [asdict(line) | {"kept": k} for line, k in zip(LINES, kept, strict=True)],
        "figures": found,
        "by_group": by(scores, lambda s: s.group),
        "by_robot": by(scores, lambda s: s.robot),
        "by_number_hidden": by(scores, lambda s: f"{len(s.answers)} hidden"),
        "by_effect": by_effect(scores),
        "confusion": confusion(scores),
        "misses": misses(scores),
        "plants": [asdict(s) for s in scores],
    }
    path.write_text(json.dumps(content, indent=1) + "\n")
    for line, k in zip(LINES, kept, strict=True):
        value = found[line.figure]
        shown = "nothing" if value is None else f"{value:.4g}"
        print(f"{'kept  ' if k else 'BROKEN'} {line.figure} = {shown} {'>=' if line.at_least else '<='} {line.limit:g}")
    for failure in found["failures"]:
        print("failed:", failure)
    return all(kept) and not found["failures"]


def run_options(parser: argparse.ArgumentParser, full: int, quick: int, seed: int) -> None:
    """Add what every study by this protocol is asked."""
    parser.add_argument("--quick", action="store_true", help=f"the first {quick} plants, result in out/")
    parser.add_argument("--plants", type=int, default=full, help="of all groups together")
    parser.add_argument("--first", type=int, default=0, help="number of the first plant")
    parser.add_argument("--seed", type=int, default=seed)
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--out", type=Path, default=None)
    parser.add_argument("--score-only", action="store_true", help="score what is finished")


def conducted(given: argparse.Namespace, count: int, out: Path, disturbed: Disturbance | None = None) -> bool:
    """Seal, simulate and diagnose; False where the folder holds another run, which is said."""
    plans = draw(given.seed, range(given.first, given.first + count), given.processes)
    try:
        publish_seals(plans, out)
    except OtherPlants as error:
        print(error, file=sys.stderr)
        return False
    Run(out, given.processes, disturbed).conduct(plans)
    return True


def main() -> int:
    """Run the protocol; exit code 1 where a pass line is crossed, 2 where the folder holds another run."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    run_options(parser, FULL, QUICK, seed=5)
    given = parser.parse_args()
    out = given.out or Path("out") / ("concealed_quick" if given.quick else "concealed")
    if not given.score_only and not conducted(given, QUICK if given.quick else given.plants, out):
        return 2
    scores = read_scores(out)
    home = HERE if len(scores) >= FULL else out
    study = {"command": "python -m validation.concealed.study", "seed": given.seed, "plants": len(scores)}
    passed = report(scores, study, home / "result.json")
    draw_picture(home / "result.json", home / "figure.png")
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
