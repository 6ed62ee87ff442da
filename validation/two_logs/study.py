"""Without a model, from simulated and real logs alone: is as much found, and as little wrong, as with the URDF?

python -m validation.two_logs.study [--quick] [--plants 24] [--seed 3] [--out out/two_logs]
Verdicts are kept in the folder; the same command goes on where it stopped. Verdicts of another source code of lagnet
are not taken up.
"""

from __future__ import annotations

import argparse
import json
import platform
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path

from validation.concealed.code import fingerprint
from validation.concealed.scoring import Score, score
from validation.concealed.summary import by_effect, figures
from validation.plants.catalogue.plan import Plan
from validation.plants.catalogue.simulate import simulate
from validation.plants.catalogue.witness import Witness, read_witness
from validation.two_logs.figure import draw
from validation.two_logs.plants import KINDS, real_arm, simulator
from validation.two_logs.routes import Route, by_simulated, by_urdf, compile_once

HERE = Path(__file__).resolve().parent
FULL, QUICK = 24, 2
LONG, SHORT = 20.0, 8.0  # [s] of a recording, in the full study and in the quick one
WITHIN = 0.05  # of the route with the URDF
COMPARED = ("precision", "recall")
SHOWN = (
    "asked",
    "claims",
    "claims_right",
    "claims_wrong",
    "named_alone",
    "named_in_a_tie",
    "named_by_the_same_torque",
    "right_joint",
    "claims_on_plants_with_nothing_hidden",
    "plants_with_nothing_hidden",
)
CODE = fingerprint()  # of the source as it is when the study starts


def verdicts(plan: Plan, routes: Sequence[Route], file: Path) -> dict:
    """The witness of a plant and its verdict by each route, kept in a file."""
    if not file.exists():
        with tempfile.TemporaryDirectory() as folder:
            witness, _ = simulate(plan, Path(folder))
            by_route = {r.name: r.verdict(plan, Path(folder)) for r in routes}
        file.write_text(json.dumps({"witness": json.loads(witness.to_json()), "verdicts": by_route}))
    return json.loads(file.read_text())


def scores(plans: Sequence[Plan], routes: Sequence[Route], folder: Path) -> Iterator[dict[str, Score]]:
    """Scores of each plant by route; gains of corrected models are not asked for."""
    folder.mkdir(parents=True, exist_ok=True)
    for plan in plans:
        kept = verdicts(plan, routes, folder / f"{plan.name}.json")
        witness = read_witness(json.dumps(kept["witness"]).encode())
        both = {name: _score(plan, witness, v) for name, v in kept["verdicts"].items()}
        said = (f"{name}: {s.right} right, {s.wrong} wrong" for name, s in both.items())
        print(plan.name, [f"{h.effect} @ {h.joint}" for h in plan.hidden], "; ".join(said), flush=True)
        yield both


def _score(plan: Plan, witness: Witness, verdict: dict) -> Score:
    spent = verdict["processor_seconds"]
    outcome = {"seconds": spent, "processor_seconds": spent, "message": "", "code": CODE}
    return score(plan, witness, verdict, outcome | {"gain_share": None, "gain_share_with_rest": None})


def report(by_route: dict[str, list[Score]], study: dict, learned: dict, home: Path) -> bool:
    """Write result.json and figure.png, print the lines; whether both were kept."""
    found = {name: figures(s) for name, s in by_route.items()}
    lines = []
    for figure in COMPARED:
        urdf, simulated = found["urdf"][figure], found["simulated"][figure]
        kept = None not in (urdf, simulated) and simulated >= urdf - WITHIN
        lines.append({"figure": figure, "urdf": urdf, "simulated": simulated, "within": WITHIN, "kept": kept})
        print("kept  " if kept else "BROKEN", figure, f"urdf {urdf}, simulated {simulated}")
    content = {
        "study": study,
        "versions": {"lagnet": version("lagnet"), "pin": version("pin"), "python": platform.python_version()},
        "code": CODE,
        "learned": learned,
        "pass_lines": lines,
        "figures": {name: {k: f[k] for k in (*COMPARED, *SHOWN)} for name, f in found.items()},
        "by_effect": {name: by_effect(s) for name, s in by_route.items()},
        "plants": {name: [asdict(s) for s in scored] for name, scored in by_route.items()},
    }
    (home / "result.json").write_text(json.dumps(content, indent=1) + "\n")
    draw(home / "result.json", home / "figure.png")
    return all(line["kept"] for line in lines)


def main() -> int:
    """Run the study; exit code 1 where a pass line is crossed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help=f"{QUICK} plants with short recordings, result in out/")
    parser.add_argument("--plants", type=int, default=FULL)
    parser.add_argument("--seed", type=int, default=3)
    parser.add_argument("--out", type=Path, default=None)
    given = parser.parse_args()
    out = given.out or Path("out") / ("two_logs_quick" if given.quick else "two_logs")
    count, duration = (QUICK, SHORT) if given.quick else (given.plants, LONG)
    kept = out.resolve() / CODE[:12]
    compile_once(kept / "compiled")
    routes = [by_urdf("ur5"), by_simulated(simulator(duration), kept / f"learned_from_{duration:g}_s")]
    print("learned:", routes[1].told, flush=True)
    plans = [real_arm(given.seed, n, duration) for n in range(count)]
    each = list(scores(plans, routes, kept / f"seed_{given.seed}_{duration:g}_s"))
    by_route = {r.name: [s[r.name] for s in each] for r in routes}
    study = {"command": "python -m validation.two_logs.study", "seed": given.seed, "plants": count, "kinds": KINDS}
    return 0 if report(by_route, study, routes[1].told, out if given.quick or count < FULL else HERE) else 1


if __name__ == "__main__":
    sys.exit(main())
