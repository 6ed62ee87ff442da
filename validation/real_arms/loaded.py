"""The UR10e calibrated without its load, then both recordings of it with a load that was mounted differently in each.

python -m validation.real_arms.loaded [--data DIR]
"""

from __future__ import annotations

import argparse
import json
import os
import tempfile
import time
from pathlib import Path
from typing import Any

from validation.real_arms.arms import UR10E

from lagnet.diagnosis.diagnose import Diagnosis, diagnose
from lagnet.diagnosis.writing import write_diagnosis
from lagnet.models.files.loading import load_any
from lagnet.recordings.loading.load import load_recording

HERE = Path(__file__).resolve().parent
FILES = ("loaded_0.csv.gz", "loaded_1.csv.gz")
ALIKE = 0.1  # relative difference of the two masses: it is one load
PREDICTED = 0.02  # nMSE of the held-out end, of joints 1 to 5
MOST_NAMES = 2  # beside the loads


def calibrated(data: Path, out: Path) -> Any:
    """The UR10e's model as corrected by its recordings without a load."""
    robot = load_any(data / UR10E.folder / UR10E.urdf)
    fit, held = (
        [load_recording(data / UR10E.folder / f, robot=robot, torque_constant=UR10E.torque_constant) for f in files]
        for files in (UR10E.fit, UR10E.holdout)
    )
    write_diagnosis(diagnose(fit, robot, held, seed=0), out)
    return load_any(out / "corrected")


def lines(result: Diagnosis) -> dict[str, bool]:
    """Pass lines of the issue, fixed before."""
    loads = [e for e in result.effects if e.effect == "payload"]
    masses = [e.value("m") for e in loads]
    named = [fit.nmse_named for fit in result.verdict.fit[:5]]
    return {
        "a load in each recording": len(loads) == len(FILES) == len({e.recording for e in loads}),
        "masses within 10 %": len(masses) == 2 and abs(masses[0] - masses[1]) < ALIKE * max(masses),
        "the difference is told": any("differ from each other" in line for line in result.verdict.warnings),
        "held-out error of joints 1 to 5 at most .02": max(named) <= PREDICTED,
        "at most two effects beside the loads": len(result.effects) - len(loads) <= MOST_NAMES,
    }


def main() -> int:
    """Run the study; 0 if every line is passed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    default = os.environ.get("LAGNET_DATA_DIR", str(HERE.parents[2] / "shared" / "data"))
    parser.add_argument("--data", type=Path, default=Path(default), help="folder of the data sets (LAGNET_DATA_DIR)")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        robot = calibrated(options.data, Path(scratch))
        folder = options.data / "ur10e_loaded"
        recordings = [load_recording(folder / f, robot=robot, torque_constant=UR10E.torque_constant) for f in FILES]
        start, cpu = time.perf_counter(), time.process_time()
        result = diagnose(recordings, robot, seed=0)
        seconds, processor = time.perf_counter() - start, time.process_time() - cpu
    found = lines(result)
    told = {
        "study": "loaded",
        "passed": all(found.values()),
        "lines": found,
        "seconds": round(seconds, 1),
        "seconds_of_processor": round(processor, 1),
        "effects": [
            {
                "effect": e.effect,
                "joint": e.joint,
                "recording": Path(e.recording).name if e.recording else None,
                "parameters": {p.name: round(p.value, 5) for p in e.parameters},
            }
            for e in result.effects
        ],
        "held_out_nmse": {
            kind: [round(getattr(fit, f"nmse_{kind}"), 5) for fit in result.verdict.fit]
            for kind in ("nominal", "named", "identified", "full")
        },
    }
    (HERE / "loaded.json").write_text(json.dumps(told, indent=1, ensure_ascii=False) + "\n")
    for claim, passed in found.items():
        print(f"{'met    ' if passed else 'NOT MET'} {claim}")
    return 0 if told["passed"] else 1


if __name__ == "__main__":
    raise SystemExit(main())
