"""Servo arms that MuJoCo and PyBullet move, with something hidden: what does a diagnosis name, and what wrongly?

python -m validation.motion_concealed.study [--quick] [--seed 21] [--kept FILE] [--out FILE]
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict
from itertools import cycle
from pathlib import Path
from typing import Any

import numpy as np

from lagnet.diagnosis.motion.diagnose import diagnose_motion
from lagnet.diagnosis.verdict.verdict import EffectFound
from validation.motion_concealed.causes import ENCODER, LISTED, UNLISTED, Cause
from validation.motion_concealed.plants import BULLET, plant

Score = Callable[[str, Cause | None, Sequence[str], Sequence[EffectFound]], dict[str, Any]]

HERE = Path(__file__).resolve().parent
QUICK = ("command_delay", None)
LONG, SHORT = 16.0, 12.0  # [s] of a recording, of which two are fitted and one is held out
KINDS = (
    "pendulum",
    "leg_bullet",
    "arm6",
    "leg",
    "pendulum_bullet",
    "pendulum",
    "so101",
    "leg_bullet",
    "leg",
    "arm6_bullet",
    "pendulum_bullet",
    "leg",
)
ALSO_SAYS = {"payload": ("load_error",), "static_friction": ("stribeck_friction",)}  # which contains it
MOST_TIED = 3
COVER = (0.9, 0.99)  # share of 95 % intervals that hold the true value
LEAST = {"precision": 0.97, "recall": 0.92}


def scored(
    plant_name: str, cause: Cause | None, joints: Sequence[str], effects: Sequence[EffectFound]
) -> dict[str, Any]:
    """Which claims are right, whether the cause was found, and how far its parameter is off."""
    right = [e for e in effects if _says(e, cause, joints)]
    row: dict[str, Any] = {
        "plant": plant_name,
        "cause": None if cause is None else asdict(cause),
        "claims": [f"{e.effect} at {e.joint}" + "".join(f" | {t}" for t in e.tied_with) for e in effects],
        "wrong": [f"{e.effect} at {e.joint}" for e in effects if not _says(e, cause, joints)],
        "found": bool(right),
    }
    if cause is None:
        return row
    for effect in right:
        for p in effect.parameters:
            if cause.parameter == p.name and effect.effect == cause.effect:
                row["error"] = abs(p.value / cause.value - 1.0)
                row["covered"] = p.ci95[0] <= cause.value <= p.ci95[1]
    return row


def _says(claim: EffectFound, cause: Cause | None, joints: Sequence[str]) -> bool:
    """Whether a claim, with at most two ties beside it, names the cause at its joint."""
    if cause is None or cause.effect in UNLISTED:
        return False
    names = {claim.effect, *claim.tied_with}
    meant = {cause.effect, *ALSO_SAYS.get(cause.effect, ())}
    at = cause.effect == "payload" or claim.joint == joints[cause.joint]
    return bool(names & meant) and len(names) <= MOST_TIED and at


def plan_of(seed: int, listed: int, empty: int, unlisted: int) -> list[str | None]:
    """What the plants hide: each listed cause so often, nothing, and unlisted ones in turn, in an order of the seed."""
    others = [name for name, _ in zip(cycle(UNLISTED), range(unlisted), strict=False)]
    hidden = [*list(LISTED) * listed, *[None] * empty, *others]
    return [hidden[i] for i in np.random.default_rng(seed).permutation(len(hidden))]


def run(
    plan: Sequence[str | None],
    seed: int,
    seconds: float,
    kinds: Sequence[str] = KINDS,
    kept: Path | None = None,
    score: Score | None = None,
) -> list[dict[str, Any]]:
    """Rows of all plants of a plan, kinds in turn.

    Args:
        plan: what each plant hides.
        seed: of the plants.
        seconds: of a recording.
        kinds: of robots and engines.
        kept: file of a row a line, added to after each plant; plants that it holds are not run again.
        score: of a plant's claims; None: `scored`.
    """
    rows = {} if kept is None or not kept.exists() else _rows_of(kept)
    with tempfile.TemporaryDirectory() as folder:
        for index, effect in enumerate(plan):
            if index in rows:
                continue
            case = plant(seed, index, kinds[index % len(kinds)], effect, seconds, Path(folder))
            begun = time.process_time()
            result = diagnose_motion(case.recordings[:2], case.robot, case.recordings[2:], servo=case.servo)
            row = (score or scored)(case.name, case.cause, case.robot.joints, result.effects)
            shown = max(e.rmse_nominal / ENCODER for e in result.verdict.errors)
            row |= {"steps": round(shown, 2), "processor_seconds": round(time.process_time() - begun, 1)}
            rows[index] = row
            print(json.dumps(row), flush=True)
            if kept is not None:
                with kept.open("a", encoding="utf-8") as file:
                    file.write(json.dumps({"index": index} | row) + "\n")
    return [rows[index] for index in sorted(rows)]


def _rows_of(kept: Path) -> dict[int, dict[str, Any]]:
    """Rows of a file by plant; a last line that is not whole is left out."""
    rows = {}
    for line in kept.read_text(encoding="utf-8").splitlines():
        try:
            row = json.loads(line)
        except json.JSONDecodeError:
            continue
        rows[row.pop("index")] = row
    return rows


def result_of(seed: int, cases: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """What result.json holds."""
    found = figures(cases)
    by = {effect: figures([c for c in cases if c["cause"] and c["cause"]["effect"] == effect]) for effect in LISTED}
    recalls = {effect: f"{found['found']} of {found['causes']}" for effect, found in by.items()}
    return {
        "study": "motion_concealed",
        "seed": seed,
        "figures": found,
        "found_by_cause": recalls,
        "processor_seconds": round(sum(c.get("processor_seconds", 0.0) for c in cases), 1),
        "cases": list(cases),
        "passed": judge(found),
    }


def write_result(path: Path, result: dict[str, Any]) -> None:
    """Writes a result file; what another script keeps in it stays."""
    before = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    kept = {key: value for key, value in before.items() if key == "confusions"}
    path.write_text(json.dumps(kept | result, indent=1, ensure_ascii=False, allow_nan=False) + "\n", encoding="utf-8")


def figures(cases: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Recall, precision, false claims and errors of parameters over all plants."""
    listed = [c for c in cases if c["cause"] and c["cause"]["effect"] in LISTED]
    claims, wrong = (sum(len(c[k]) for c in cases) for k in ("claims", "wrong"))
    errors = [c["error"] for c in listed if "error" in c]
    return {
        "plants": len(cases),
        "causes": len(listed),
        "found": sum(c["found"] for c in listed),
        "recall": sum(c["found"] for c in listed) / len(listed) if listed else None,
        "claims": claims,
        "wrong_claims": wrong,
        "precision": (claims - wrong) / claims if claims else None,
        "plants_where_nothing_is_hidden": sum(c["cause"] is None for c in cases),
        "plants_of_unlisted_physics": sum(bool(c["cause"]) and c["cause"]["effect"] in UNLISTED for c in cases),
        "plants_of_pybullet": sum(BULLET in c["plant"] for c in cases),
        "claims_where_nothing_is_hidden": sum(len(c["claims"]) for c in cases if c["cause"] is None),
        "claims_of_unlisted_physics": sum(
            len(c["claims"]) for c in cases if c["cause"] and c["cause"]["effect"] in UNLISTED
        ),
        "median_parameter_error": float(np.median(errors)) if errors else None,
        "parameters": len(errors),
        "intervals_that_cover": float(np.mean([c["covered"] for c in listed if "covered" in c])) if errors else None,
    }


def judge(found: dict[str, Any]) -> dict[str, bool]:
    """The pass line of README.md."""
    shares = {name: found[name] is not None and found[name] >= least for name, least in LEAST.items()}
    shares |= {name: found[name] == 0 for name in ("claims_where_nothing_is_hidden", "claims_of_unlisted_physics")}
    close = found["median_parameter_error"]
    cover = found["intervals_that_cover"]
    return shares | {
        "median_parameter_error": close is not None and close <= 0.05,
        "intervals_that_cover": cover is not None and COVER[0] <= cover <= COVER[1],
    }


def main() -> int:
    """Run the study; 0 if every line is passed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="two pendulums, short; writes nothing")
    parser.add_argument("--listed", type=int, default=9, help="plants of every listed cause")
    parser.add_argument("--empty", type=int, default=20, help="plants that hide nothing")
    parser.add_argument("--unlisted", type=int, default=12, help="plants with unlisted physics")
    parser.add_argument("--seed", type=int, default=21)
    parser.add_argument("--kept", type=Path, help="file of a row a plant, from which an interrupted run goes on")
    parser.add_argument("--out", type=Path, default=HERE / "result.json", help="file of the result")
    options = parser.parse_args()
    if options.quick:
        result = result_of(options.seed, run(QUICK, options.seed, SHORT, ("pendulum",)))
    else:
        plan = plan_of(options.seed, options.listed, options.empty, options.unlisted)
        result = result_of(options.seed, run(plan, options.seed, LONG, kept=options.kept))
        write_result(options.out, result)
    print(json.dumps(result["figures"] | {"passed": result["passed"]}, indent=1))
    return 0 if all(result["passed"].values()) else 1


if __name__ == "__main__":
    raise SystemExit(main())
