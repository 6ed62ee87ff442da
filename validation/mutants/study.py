"""Which check catches which sabotage: the table mutant × check, written to result.json.

python -m validation.mutants.study
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path
from typing import Any

import jax
import numpy as np

from lagnet.models.features import fit_features
from lagnet.models.files.saving import load_model
from lagnet.models.kinds import ModelSpec, draw, settings_class
from lagnet.models.learned_model import LearnedModel
from lagnet.models.scales import fit_scales
from lagnet.plausibility.checks import CHECKS
from lagnet.plausibility.checks.base_angle_independence import BaseAngleIndependence
from lagnet.plausibility.settings import CheckSettings
from lagnet.plausibility.suite import check
from lagnet.rigid_body.random_arm import random_arm
from lagnet.rigid_body.robot import load_description
from validation.mutants.bench import sound
from validation.mutants.mutants import MUTANTS, Mutant

HERE = Path(__file__).resolve().parent
TRAINED = HERE.parents[1] / "tests" / "models" / "fixtures" / "ur5_delan"
ARMS = 50
SECONDS = 20.0  # of processor time for a learned model of seven joints


def examine(mutant: Mutant, seed: int = 0) -> dict[str, Any]:
    """One row of the table."""
    case = mutant.build()
    report = check(case.model, case.reference, case.recordings, seed=seed, settings=case.settings)
    caught = [c.name for c in report.failures]
    return {
        "mutant": mutant.name,
        "what": mutant.what,
        "meant_for": mutant.meant_for,
        "caught_by": caught,
        "caught_as_meant": mutant.meant_for in caught,
        "said": next((c.sentence() for c in report.failures if c.name == mutant.meant_for), ""),
    }


def false_alarms(count: int = ARMS) -> list[dict[str, Any]]:
    """Random sound arms of 1 to 8 joints of all kinds, against themselves; those on which a check fails."""
    alarms = []
    for seed in range(count):
        arm = random_arm(1 + seed % 8, seed)
        report = check(arm, arm, seed=seed)
        alarms += [{"seed": seed, "check": c.name, "said": c.sentence()} for c in report.failures]
    return alarms


def trained_delan() -> dict[str, Any]:
    """A network that learned the UR-5, against the UR-5; and what it gets for a symmetry that it was not built with."""
    model, arm = load_model(TRAINED), load_description("ur5")
    asked = check(model, arm, settings=CheckSettings(vertical_base=True))[BaseAngleIndependence.name]
    report = check(model, arm)
    return {
        "passes": report.passed,
        "failures": [c.sentence() for c in report.failures],
        "base_angle_independence": {"asked": asked.status, "value": asked.value, "limit": asked.limit},
    }


def seven_joints() -> dict[str, Any]:
    """Processor time to check a DeLaN-FFNN of seven joints, compilation included."""
    rng, joints = np.random.default_rng(0), tuple(f"joint_{i}" for i in range(7))
    q, v, a = (rng.normal(size=(400, 7)) for _ in range(3))
    features, scales = fit_features(q, ("revolute",) * 7), fit_scales(v, a, a)
    spec = ModelSpec("delan-ffnn", settings_class("delan-ffnn")(), joints, features, scales)
    model = LearnedModel(spec, draw(spec, jax.random.key(0)))
    begin = time.process_time()
    passes = check(model).passed
    return {"kind": spec.kind, "passes": passes, "processor_seconds": round(time.process_time() - begin, 1)}


def result() -> dict[str, Any]:
    """The study: rows, which mutants only one check catches, checks kept for another reason, false alarms."""
    begin = time.perf_counter()
    rows = [examine(mutant) for mutant in MUTANTS]
    alone: dict[str, list[str]] = {kind.name: [] for kind in CHECKS}
    for row in rows:
        if len(row["caught_by"]) == 1:
            alone[row["caught_by"][0]].append(row["mutant"])
    alarms, trained, seven = false_alarms(), trained_delan(), seven_joints()
    quick = seven["passes"] and seven["processor_seconds"] <= SECONDS
    seconds = time.perf_counter() - begin
    unjustified = [kind.name for kind in CHECKS if not alone[kind.name] and not kind.stays_because]
    return {
        "study": "mutants",
        "pass": all(r["caught_as_meant"] for r in rows)
        and not alarms
        and not unjustified
        and len(rows) >= 25
        and trained["passes"]
        and quick,
        "mutants": len(rows),
        "caught_as_meant": sum(r["caught_as_meant"] for r in rows),
        "sound_arm_passes": check(sound(), sound()).passed,
        "random_arms": ARMS,
        "false_alarms": alarms,
        "trained_delan": trained,
        "seven_joints": seven,
        "caught_by_this_check_alone": alone,
        "kept_for_another_reason": {k.name: k.stays_because for k in CHECKS if k.stays_because},
        "neither": unjustified,
        "seconds": round(seconds, 1),
        "rows": rows,
    }


if __name__ == "__main__":
    found = result()
    (HERE / "result.json").write_text(json.dumps(found, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    print(json.dumps({k: v for k, v in found.items() if k not in ("rows", "kept_for_another_reason")}, indent=1))
    sys.exit(not found["pass"])
