"""Arms simulated by MuJoCo with something hidden: what does the diagnosis name, and what does it name wrongly?

python -m validation.another_simulator.study [--quick] [--plants 46] [--seed 2 ...]
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Sequence
from dataclasses import asdict
from importlib.metadata import version
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from lagnet.diagnosis.diagnose import Diagnosis, diagnose
from validation.another_simulator.hidden import UNLISTED, Hidden
from validation.another_simulator.plants import Plant, plant
from validation.concealed.code import fingerprint

HERE = Path(__file__).resolve().parent
FULL, QUICK = 46, 2
LONG, SHORT = 22.0, 10.0  # [s] of a run, two of which are cut off at its start
MOST_TIED = 3
LEAST = {"precision": 0.97, "recall": 0.97}
CODE = fingerprint()


def scored(case: Plant, result: Diagnosis) -> dict[str, Any]:
    """Which claims are right, and which causes were found."""
    listed = [h for h in case.hidden if h.effect not in UNLISTED]
    right = [any(_says(e, h, case.robot.joints) or _is_its_rotor(e, h, case) for h in listed) for e in result.effects]
    asked = [h for h, shown in zip(case.hidden, case.shown, strict=True) if shown and h in listed]
    found = [any(_says(e, h, case.robot.joints) for e in result.effects) for h in asked]
    return {
        "plant": case.name,
        "joints": len(case.robot.joints),
        "hidden": [asdict(h) for h in case.hidden],
        "not_shown": [h.effect for h, shown in zip(case.hidden, case.shown, strict=True) if not shown],
        "listed": len(asked),
        "claims": [_told(e) for e in result.effects],
        "wrong": [f"{e.effect} at {e.joint}" for e, r in zip(result.effects, right, strict=True) if not r],
        "found": int(np.sum(found)),
        "unexplained": [u.joint for u in result.verdict.unexplained if u.above_noise],
    }


def _told(claim: Any) -> str:
    places = " or ".join((str(claim.joint), *claim.also_at))
    return f"{claim.effect} at {places}" + "".join(f" | {t}" for t in claim.tied_with)


def _says(claim: Any, cause: Hidden, joints: Sequence[str]) -> bool:
    """Whether a claim, with at most two ties beside it, names a cause at its joint; ties of places count likewise."""
    names = {claim.effect, *(t.split(" ")[0].split("@")[0] for t in claim.tied_with)}
    places = {claim.joint, *claim.also_at}
    place = None if cause.joint is None else joints[cause.joint]
    at_it = place is None or claim.joint is None or (place in places and len(places) <= MOST_TIED)
    return cause.effect in names and len(names) <= MOST_TIED and at_it


def _is_its_rotor(claim: Any, cause: Hidden, case: Plant) -> bool:
    """Whether a claim is the rotor before a flexible joint, which is put in with it: right, but not the flexibility."""
    flexible = cause.effect == "joint_elasticity" and cause.joint is not None
    return flexible and claim.effect == "rotor_inertia" and claim.joint == case.robot.joints[cause.joint or 0]


def run(plants: int, seeds: Sequence[int], seconds: float) -> dict[str, Any]:
    """All plants of some seeds, so many of each."""
    cases: list[dict[str, Any]] = []
    for seed, index in product(seeds, range(plants)):
        case = plant(seed, index, seconds)
        began = time.process_time()
        result = diagnose(case.recordings[:-1], case.robot, case.recordings[-1:], seed=0)
        seconds_of_processor = round(time.process_time() - began, 1)
        cases.append({"seed": seed} | scored(case, result) | {"processor_seconds": seconds_of_processor})
        print(json.dumps({k: cases[-1][k] for k in ("plant", "claims", "wrong", "found", "listed")}), flush=True)
    return {"study": "another_simulator", "seeds": [*seeds], "figures": figures(cases), "cases": cases}


def figures(cases: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Precision, recall and false claims over all plants."""
    claims, wrong = (sum(len(c[k]) for c in cases) for k in ("claims", "wrong"))
    listed, found = (sum(c[k] for c in cases) for k in ("listed", "found"))
    empty = [c for c in cases if not c["hidden"]]
    strange = [c for c in cases if c["hidden"] and all(h["effect"] in UNLISTED for h in c["hidden"])]
    return {
        "plants": len(cases),
        "claims": claims,
        "wrong_claims": wrong,
        "precision": (claims - wrong) / claims if claims else None,
        "causes": listed,
        "causes_not_shown": sum(len(c["not_shown"]) for c in cases),
        "found": found,
        "recall": found / listed if listed else None,
        "plants_with_nothing_hidden": len(empty),
        "of_these_with_a_claim": sum(bool(c["claims"]) for c in empty),
        "plants_with_unlisted_physics": len(strange),
        "of_these_with_a_wrong_name": sum(bool(c["wrong"]) for c in strange),
        "median_processor_seconds": float(np.median([c["processor_seconds"] for c in cases])),
    }


def judge(found: dict[str, Any]) -> dict[str, bool]:
    """The pass line of README.md."""
    shares = {name: found[name] is not None and found[name] >= least for name, least in LEAST.items()}
    return shares | {"nothing_hidden": found["of_these_with_a_claim"] == 0}


def main() -> int:
    """Run the study; 0 if every line is passed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="two plants, short; writes nothing")
    parser.add_argument("--plants", type=int, default=FULL)
    parser.add_argument("--seed", type=int, nargs="+", default=[2])
    options = parser.parse_args()
    result = run(QUICK if options.quick else options.plants, options.seed, SHORT if options.quick else LONG)
    passed = judge(result["figures"])
    print(json.dumps(result["figures"] | {"passed": passed}, indent=1))
    if not options.quick:
        about = {"passed": passed, "code": CODE, "versions": {n: version(n) for n in ("lagnet", "mujoco")}}
        (HERE / "result.json").write_text(json.dumps(result | about, indent=1, ensure_ascii=False) + "\n")
    return 0 if all(passed.values()) else 1


if __name__ == "__main__":
    raise SystemExit(main())
