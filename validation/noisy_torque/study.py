"""The concealment protocol on plants whose torque is noisy: white, 5 to 30 % of the variation of each joint.

python -m validation.noisy_torque.study [--plants 60] [--seed 77] [--out out/noisy_torque] [--score-only] [--quick]
A stopped run goes on when the same command is given again.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from validation.concealed.scoring import read_scores
from validation.concealed.study import conducted, report, run_options
from validation.noisy_torque.plants import WhiteNoise

HERE = Path(__file__).resolve().parent
FULL, QUICK = 60, 2


def main() -> int:
    """Run the protocol; exit code 1 where a pass line is crossed, 2 where the folder holds another run."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    run_options(parser, FULL, QUICK, seed=77)
    given = parser.parse_args()
    out = given.out or Path("out") / ("noisy_torque_quick" if given.quick else "noisy_torque")
    if not given.score_only and not conducted(given, QUICK if given.quick else given.plants, out, WhiteNoise()):
        return 2
    scores = read_scores(out)
    home = HERE if len(scores) >= FULL else out
    study = {"command": "python -m validation.noisy_torque.study", "seed": given.seed, "plants": len(scores)}
    passed = report(scores, study, home / "result.json")
    return 0 if passed or given.quick else 1


if __name__ == "__main__":
    sys.exit(main())
