"""What does each rule and step of a diagnosis buy? The same concealed plants, with one taken out at a time.

python -m validation.ablations.study [--quick] [--plants 48] [--seed 23] [--out out/ablations]
Plants and verdicts are kept in the folder; the same command goes on where it stopped. Verdicts of another source code
of lagnet are not taken up.
"""

from __future__ import annotations

import argparse
import json
import platform
import sys
import time
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path

from lagnet.diagnosis.diagnose import diagnose
from validation.ablations.figure import draw
from validation.ablations.gains import Row, Told, kind_of, rule_rows
from validation.ablations.kept_plants import KeptPlant, keep
from validation.ablations.patience import patience
from validation.ablations.remembered import remembered
from validation.ablations.table import ABLATIONS, NOTHING, WITHOUT_RULE, Ablation, ablation_named
from validation.ablations.taken_out import taken_out
from validation.concealed.code import fingerprint
from validation.concealed.scoring import score

HERE = Path(__file__).resolve().parent
FULL, QUICK = 48, (0,)
SHORT = (NOTHING, *WITHOUT_RULE, ablation_named("ties"))  # of a quick run
CODE = fingerprint()  # of the source as it is when the study starts


def answer(plant: KeptPlant, ablation: Ablation, file: Path) -> dict:
    """The verdict without a rule and what it took, kept in a file."""
    if not file.exists():
        robot, recordings = plant.read()
        began, message, verdict = time.process_time(), "", None
        with taken_out(ablation.instead):
            try:
                with patience():
                    verdict = diagnose(
                        recordings[:-1], robot, recordings[-1:], rules=ablation.rules, limits=ablation.limits
                    ).verdict.to_dict()
            except Exception as error:  # what a rule protects from may be a breakdown
                message = f"{type(error).__name__}: {error}"
        seconds = time.process_time() - began
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps({"verdict": verdict, "message": message, "processor_seconds": seconds}))
    return json.loads(file.read_text())


def scored(plant: KeptPlant, ablation: Ablation, file: Path) -> Told:
    """One plant's verdict without a rule, against the truth; gains of corrected models are not asked for."""
    kept = answer(plant, ablation, file)
    spent = kept["processor_seconds"]
    outcome = {"seconds": spent, "processor_seconds": spent, "message": kept["message"], "code": CODE}
    outcome |= {"gain_share": None, "gain_share_with_rest": None}
    mismatch = kept["verdict"] is not None and kept["verdict"]["mismatch"]["found"]
    return Told(score(plant.plan, plant.witness, kept["verdict"], outcome), mismatch)


def conduct(
    seed: int, numbers: Sequence[int], out: Path, ablations: Sequence[Ablation] = ABLATIONS
) -> dict[str, list[Told]]:
    """Scores of all plants under every ablation; plant by plant, so that a stopped run compares like with like."""
    scores: dict[str, list[Told]] = {a.name: [] for a in ablations}
    for number in numbers:
        plant = keep(seed, number, out / "plants")
        with remembered():
            for ablation in ablations:
                folder = out / "verdicts" / CODE[:12] / f"seed_{seed}" / ablation.name.replace(" ", "_")
                scores[ablation.name].append(scored(plant, ablation, folder / f"{plant.plan.name}.json"))
        said = (f"{name}: {s[-1].score.right}+{s[-1].score.wrong}" for name, s in scores.items())
        print(plant.plan.name, plant.plan.group, ", ".join(said), flush=True)
    return scores


def report(rows: Sequence[Row], study: dict, home: Path) -> bool:
    """Write result.json and figure.png, print the table; whether every rule earned its place."""
    content = {
        "study": study,
        "versions": {"lagnet": version("lagnet"), "pin": version("pin"), "python": platform.python_version()},
        "code": CODE,
        "rules": {row.name.replace(" ", "_"): row.told() for row in rows},
        "rules_that_buy_nothing": _idle(rows, "rule"),
        "steps_that_buy_nothing": _idle(rows, "step"),
        "pass_line_kept": not _idle(rows, "rule"),
    }
    (home / "result.json").write_text(json.dumps(content, indent=1) + "\n")
    draw(home / "result.json", home / "figure.png")
    for row in rows:
        print(row.line())
    return content["pass_line_kept"]


def _idle(rows: Sequence[Row], kind: str) -> list[str]:
    """Names of those of a kind that do not earn their place."""
    return [row.name for row in rows if kind_of(row.name) == kind and not row.earns]


def main() -> int:
    """Run the study; exit code 1 where a rule buys nothing that was measured."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="one plant, the rules alone, result in out/")
    parser.add_argument("--plants", type=int, default=FULL)
    parser.add_argument("--seed", type=int, default=23)
    parser.add_argument("--out", type=Path, default=None)
    given = parser.parse_args()
    out = given.out or Path("out") / ("ablations_quick" if given.quick else "ablations")
    numbers = QUICK if given.quick else range(given.plants)
    out.mkdir(parents=True, exist_ok=True)
    rows = rule_rows(conduct(given.seed, numbers, out, SHORT if given.quick else ABLATIONS))
    study = {"command": "python -m validation.ablations.study", "seed": given.seed, "plants": len(numbers)}
    return 0 if report(rows, study, HERE if len(numbers) >= FULL else out) else 1


if __name__ == "__main__":
    sys.exit(main())
