"""What does each rule, step and limit of a diagnosis buy? The same plants, with one taken out or changed at a time.

python -m validation.ablations.study [--quick] [--simulated 48 16] [--textured 24 8] [--report] [--out out/ablations]
Plants and verdicts are kept in the folder; the same command goes on where it stopped, and --report writes the result of
what is finished. Verdicts of another source code of lagnet are not taken up. Recordings of real arms, for the texture,
are read from LAGNET_DATA_DIR.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from validation.ablations.answers import Asked
from validation.ablations.plan import EVERY, OF_RULES, SIMULATED, STAGES, TEXTURED, Source, Stage, turns
from validation.ablations.report import CODE, report

HERE = Path(__file__).resolve().parent
SEEDS = {SIMULATED: 47, TEXTURED: 48}
CHECKED = 3  # of so many plants one is asked afresh without something that had no effect on it
QUICK = (Stage(OF_RULES, lambda s: range(s.all)),)


def conduct(sources: tuple[Source, ...], stages: Sequence[Stage], out: Path, data: Path) -> None:
    """Ask every plant under the ablations of its stage; what is kept already is not asked again."""
    for stage in stages:
        for source, number in turns(sources, stage):
            plant = source.plant(number, out, data)
            if plant is None:
                print(f"{source.kind} plant {number}: its closed loop was lost", flush=True)
                continue
            asked = Asked(plant, folder_of(out, source, number), EVERY)
            _ask(asked, stage)
            _check(asked, stage, number)
            print(f"{source.kind} {plant.plan.name} {plant.plan.group}: {len(stage.ablations)} ablations", flush=True)


def folder_of(out: Path, source: Source, number: int) -> Path:
    """Where the verdicts of a plant are."""
    return out / "verdicts" / CODE[:12] / f"{source.kind}_{source.seed}" / f"plant_{number:04d}"


def _ask(asked: Asked, stage: Stage) -> None:
    for ablation in stage.ablations:
        if asked.has_effect(ablation):
            asked.without(ablation)


def _check(asked: Asked, stage: Stage, number: int) -> None:
    """Of every third plant, one ablation without an effect, drawn by chance, is run nevertheless."""
    idle = [a for a in stage.ablations if not asked.has_effect(a)]
    if number % CHECKED == 0 and idle:
        asked.afresh(idle[int(np.random.default_rng(number).integers(len(idle)))])


def main() -> int:
    """Run the study; exit code 1 where a rule buys nothing that was measured."""
    given = _arguments()
    out = given.out or Path("out") / ("ablations_quick" if given.quick else "ablations")
    sources = tuple(Source(k, SEEDS[k], *n) for k, n in ((SIMULATED, given.simulated), (TEXTURED, given.textured)))
    if given.quick:
        sources = (Source(SIMULATED, SEEDS[SIMULATED], 1, 1),)
    out.mkdir(parents=True, exist_ok=True)
    if not given.report:
        conduct(sources, QUICK if given.quick else STAGES, out, given.data)
    folders = {s.kind: {n: folder_of(out, s, n) for n in range(s.all)} for s in sources}
    plants = {s.kind: out / "plants" / s.kind / f"seed_{s.seed}" for s in sources}
    return 0 if report(folders, plants, SEEDS, out if given.quick else HERE) else 1


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    many = {"type": int, "nargs": 2, "metavar": ("ALL", "FEW")}
    parser.add_argument("--quick", action="store_true", help="one plant, the rules alone, result in out/")
    parser.add_argument("--simulated", default=(48, 16), help="plants, and those asked for steps and limits", **many)
    parser.add_argument("--textured", default=(24, 8), help="the same of plants with the texture of real arms", **many)
    parser.add_argument("--report", action="store_true", help="run nothing, write the result of what is finished")
    default = os.environ.get("LAGNET_DATA_DIR", str(HERE.parents[2] / "shared" / "data"))
    parser.add_argument("--data", type=Path, default=Path(default), help="folder of the data sets (LAGNET_DATA_DIR)")
    parser.add_argument("--out", type=Path, default=None)
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
