"""Diagnoses cases with whatever lagnet is on the path, by calls that every version has, and keeps the verdicts.

python validation/same_verdicts/told.py CASES.json FOLDER
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path

import lagnet


def main() -> None:
    """One file a case, and the seconds of processor that its diagnosis took."""
    cases, folder = json.loads(Path(sys.argv[1]).read_text()), Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    for case in cases:
        file = folder / f"{case['name']}.json"
        if file.exists():
            continue
        robot, constant = lagnet.load_robot(case["robot"]), case["torque_constant"]
        fit, held = (
            [lagnet.load_recording(f, robot=robot, torque_constant=constant) for f in case[part]]
            for part in ("fit", "holdout")
        )
        began = time.process_time()
        verdict = lagnet.diagnose(fit, robot=robot, holdout=held, seed=0).to_json()
        seconds = time.process_time() - began
        file.write_text(json.dumps({"processor_seconds": seconds, "verdict": json.loads(verdict)}))
        print(f"{folder.name} {case['name']}: {seconds:.1f} s", flush=True)


if __name__ == "__main__":
    main()
