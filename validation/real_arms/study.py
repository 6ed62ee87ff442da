"""Diagnose three real arms and hold the verdicts against lines fixed beforehand.

python -m validation.real_arms.study [--quick] [--data DIR]
"""

from __future__ import annotations

import json
import tempfile
import time
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from validation.real_arms.arms import EMPS, EMPS_WHOLE, TX40, UR10E, Arm
from validation.real_arms.metric import at_rest, low_passed, nmse, read_torques, stretches
from validation.real_arms.options import parser_of

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.writing import write_diagnosis
from lagnet.models.files.loading import load_any
from lagnet.recordings.loading.load import load_recording
from lagnet.recordings.recording import Recording

HERE = Path(__file__).resolve().parent
QUICK, ALL = (EMPS, EMPS_WHOLE, TX40), (EMPS, EMPS_WHOLE, TX40, UR10E)


def study_arm(arm: Arm, data: Path, out: Path) -> dict[str, Any]:
    """One diagnosis: effects, errors and pass lines."""
    folder = data / arm.folder
    robot = load_any(folder / arm.urdf)
    read = [
        [load_recording(folder / f, robot=robot, torque_constant=arm.torque_constant) for f in files]
        for files in (arm.fit, arm.holdout)
    ]
    start = time.perf_counter()
    result = diagnose(read[0], robot, read[1] or None, seed=0)
    seconds = time.perf_counter() - start
    write_diagnosis(result, out)
    verdict = json.loads((out / "verdict.json").read_text())
    table = read_torques(out / "holdout_torque.parquet")
    joints = range(len(robot.joints))
    corrected = [nmse(table, j, "corrected") for j in joints]
    return {
        "seconds": round(seconds, 1),
        "bandwidth_hz": verdict["conditioning"]["bandwidth_hz"],
        "nmse_nominal": [round(nmse(table, j, "nominal"), 5) for j in joints],
        "nmse_corrected": [round(x, 5) for x in corrected],
        **_at_rest(table, read[1], len(joints)),
        "effects": [_short(e) for e in verdict["effects"]],
        "unexplained": [u for u in verdict["unexplained"] if u["above_noise"]],
        "lines": [asdict(line) for line in arm.judge(verdict, corrected)],
    }


def _at_rest(table: dict[str, np.ndarray], held_out: list[Recording], n_dof: int) -> dict[str, Any]:
    """What rest has of the error and the error in motion; only where one recording is held out whole."""
    if len(held_out) != 1:
        return {}
    pairs = [at_rest(table, j, "corrected", held_out[0]) for j in range(n_dof)]
    shares, moving = ([round(x, 5) for x in part] for part in zip(*pairs, strict=True))
    return {"share_of_error_at_rest": shares, "nmse_in_motion": moving}


def _short(effect: dict[str, Any]) -> dict[str, Any]:
    parameters = {p["name"]: {"value": p["value"], "unit": p["unit"], "ci95": p["ci95"]} for p in effect["parameters"]}
    return {"effect": effect["effect"], "joint": effect["joint"], "tied_with": effect["tied_with"]} | {
        "parameters": parameters
    }


def draw(tables: dict[str, dict[str, np.ndarray]], path: Path) -> None:
    """Measured, nominal and corrected torque of every joint on the held-out recordings, at 5 Hz."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    panels = [(arm, j) for arm, table in tables.items() for j in range(sum(n.startswith("tau_m") for n in table))]
    figure, axes = plt.subplots(len(panels), 1, figsize=(9, 1.7 * len(panels)), squeeze=False, layout="constrained")
    for (arm, joint), axis in zip(panels, axes[:, 0], strict=True):
        table = tables[arm]
        rows = max(stretches(table), key=lambda r: r.stop - r.start)
        clock = table["time"][rows]
        for kind, colour in (("nominal", "0.7"), ("measured", "C0"), ("corrected", "C3")):
            y = low_passed(clock, table[f"tau_{kind}_{joint}"][rows])
            axis.plot(np.linspace(clock[0], clock[-1], y.size), y, colour, lw=0.9, label=kind)
        axis.set_ylabel(f"{arm} {joint}", fontsize=7)
        axis.tick_params(labelsize=6)
    axes[0, 0].legend(ncols=3, fontsize=7, loc="upper right")
    axes[-1, 0].set_xlabel("time [s]")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main() -> int:
    """Run the study; 0 if every line is passed."""
    options = parser_of(__doc__, "without the UR10e").parse_args()
    arms: dict[str, Any] = {}
    tables = {}
    with tempfile.TemporaryDirectory() as scratch:
        for arm in QUICK if options.quick else ALL:
            out = Path(scratch) / arm.name
            arms[arm.name] = study_arm(arm, options.data, out)
            tables[arm.name] = read_torques(out / "holdout_torque.parquet")
            for line in arms[arm.name]["lines"]:
                print(f"{'met    ' if line['passed'] else 'NOT MET'} {arm.name}: {line['claim']}: {line['found']}")
    passed = all(line["passed"] for arm in arms.values() for line in arm["lines"])
    if not options.quick:
        result = {"study": "real_arms", "passed": passed, "arms": arms}
        (HERE / "result.json").write_text(json.dumps(result, indent=1, ensure_ascii=False) + "\n")
        draw(tables, HERE / "holdout.png")
    return 0 if passed else 1


if __name__ == "__main__":
    raise SystemExit(main())
