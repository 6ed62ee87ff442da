"""Hide something known in real recordings, and ask the diagnosis for it.

python -m validation.real_concealed.study [--quick] [--data DIR]
"""

from __future__ import annotations

import argparse
import json
import os
import time
from pathlib import Path
from typing import Any

from lagnet.diagnosis.diagnose import Diagnosis, diagnose
from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.files.loading import load_any
from lagnet.recordings.loading.load import load_recording
from lagnet.recordings.recording import Recording
from validation.real_arms.arms import UR10E
from validation.real_concealed.hide import Hiding, hidings

HERE = Path(__file__).resolve().parent
CALIBRATE, FIT = slice(0, 2), slice(2, 4)  # of the fit files: what calibrates the arm is not what is diagnosed
SMALL = (
    0.05  # of the mismatch: a claim that explains less beside the hidden thing is told, and does not count against it
)


def read(data: Path) -> tuple[Any, list[Recording], list[Recording]]:
    """Robot, recordings to fit, and the one that is held out."""
    folder = data / UR10E.name
    robot = load_any(folder / UR10E.urdf)
    files = [
        [load_recording(folder / f, robot=robot, torque_constant=UR10E.torque_constant) for f in part]
        for part in (UR10E.fit, UR10E.holdout)
    ]
    return robot, files[0], files[1]


def judge(hiding: Hiding, result: Diagnosis, joints: tuple[str, ...]) -> dict[str, Any]:
    """What was found against what was hidden."""
    place = None if hiding.joint is None else joints[hiding.joint]
    hits = [
        e
        for e in result.effects
        if e.joint == place and (e.effect in hiding.effects or set(hiding.effects) & set(e.tied_with))
    ]
    entry: dict[str, Any] = {
        "hidden": hiding.name,
        "at": place,
        "found": bool(hits) if hiding.effects else None,
        "unique": bool(hits) and not hits[0].tied_with,
        "claims": [
            {
                "effect": e.effect,
                "joint": e.joint,
                "tied_with": list(e.tied_with),
                "share_of_mismatch": e.evidence.share_of_mismatch,
            }
            for e in result.effects
        ],
    }
    named = [e for e in hits if e.effect in hiding.effects]
    if named and hiding.parameter and hiding.value is not None:
        found = next(p for p in named[0].parameters if p.name == hiding.parameter)
        entry |= {
            "parameter": hiding.parameter,
            "hidden_value": hiding.value,
            "found_value": found.value,
            "ci95": list(found.ci95),
            "relative_error": abs(found.value - hiding.value) / abs(hiding.value),
        }
    beside = [e for e in result.effects if e not in hits and e.evidence.share_of_mismatch > SMALL]
    entry["other_claims_over_5_percent"] = [f"{e.effect} at {e.joint}" for e in beside]
    return entry


def run(data: Path, quick: bool) -> dict[str, Any]:
    """Calibrate on two recordings, hide in two others and in the held-out one, diagnose."""
    robot, fit, held = read(data)
    first, second = fit[CALIBRATE][: 1 if quick else None], fit[FIT][: 1 if quick else None]
    calibrated: CorrectedModel = diagnose(first, robot, second, seed=0).corrected
    cases = []
    for hiding in hidings(calibrated)[: 2 if quick else None]:
        nominal, (seen, unseen) = hiding.apply(calibrated, (second, held))
        start = time.process_time()
        entry = judge(hiding, diagnose(seen, nominal, unseen, seed=0), robot.joints)
        cases.append(entry | {"processor_seconds": round(time.process_time() - start, 1)})
        print(json.dumps(entry, ensure_ascii=False), flush=True)
    asked = [c for c in cases if c["found"] is not None]
    figures = {"hidden": len(asked), "found": sum(c["found"] for c in asked), "unique": sum(c["unique"] for c in asked)}
    return {"study": "real_concealed", "figures": figures, "cases": cases}


def main() -> int:
    """Run the study; 0 if everything hidden was found."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="two cases on half of the recordings; writes nothing")
    default = os.environ.get("LAGNET_DATA_DIR", str(HERE.parents[2] / "shared" / "data"))
    parser.add_argument("--data", type=Path, default=Path(default), help="folder of the data sets (LAGNET_DATA_DIR)")
    options = parser.parse_args()
    result = run(options.data, options.quick)
    if not options.quick:
        (HERE / "result.json").write_text(json.dumps(result, indent=1, ensure_ascii=False) + "\n")
    return 0 if result["figures"]["found"] == result["figures"]["hidden"] else 1


if __name__ == "__main__":
    raise SystemExit(main())
