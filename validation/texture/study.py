"""The concealment protocol on plants whose torque carries what real arms leave unexplained, and the odds of its names.

python -m validation.texture.study [--plants 48] [--seed 31] [--out out/texture] [--score-only] [--quick]
Recordings of real arms are read from LAGNET_DATA_DIR. A stopped run goes on when the same command is given again.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from pathlib import Path

from lagnet.diagnosis.settings import DecisionLimits
from validation.concealed.reliability import named_against_the_odds, odds_of, reliability
from validation.concealed.scoring import read_scores
from validation.concealed.study import conducted, report, run_options
from validation.texture.plants import RealTexture
from validation.texture.remainders import read_remainders

HERE = Path(__file__).resolve().parent
FULL, QUICK = 48, 2


def main() -> int:
    """Run the protocol; exit code 1 where a pass line is crossed, 2 where the folder holds another run."""
    given = arguments()
    out = given.out or Path("out") / ("texture_quick" if given.quick else "texture")
    if not given.score_only:
        texture = RealTexture(read_remainders(given.data, out / "remainders.npz"))
        if not conducted(given, QUICK if given.quick else given.plants, out, texture):
            return 2
    scores = read_scores(out)
    home = HERE if len(scores) >= FULL else out
    study = {"command": "python -m validation.texture.study", "seed": given.seed, "plants": len(scores)}
    passed = report(scores, study, home / "result.json")
    _with_odds(out, home / "result.json")
    return 0 if passed or given.quick else 1


def _with_odds(out: Path, path: Path) -> None:
    """Add to the result how often a name is right by its odds."""
    rows = odds_of(out, read_scores(out))
    result = json.loads(path.read_text())
    result["reliability"] = reliability(rows)
    result["named_against_the_odds"] = named_against_the_odds(rows, DecisionLimits().tie_odds)
    path.write_text(json.dumps(result, indent=1) + "\n")
    for row in result["reliability"]:
        print(row)


def arguments() -> argparse.Namespace:
    """What was asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    default = os.environ.get("LAGNET_DATA_DIR", str(HERE.parents[2] / "shared" / "data"))
    parser.add_argument("--data", type=Path, default=Path(default), help="folder of the data sets (LAGNET_DATA_DIR)")
    run_options(parser, FULL, QUICK, seed=31)
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
