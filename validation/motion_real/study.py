"""Real servos without torque: a diagnosis on motion beside CMA-ES. Question, data and pass line: README.md."""

from __future__ import annotations

import argparse
import json
import os
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from lagnet.diagnosis.motion.diagnose import diagnose_motion
from lagnet.recordings.loading.load import load_recording
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.robot import load_description
from validation.motion_real.rival import fitted_by_search, rolled

HERE = Path(__file__).parent
DATA = Path(os.environ.get("LAGNET_DATA_DIR", HERE.parents[2] / "shared" / "data"))
ARM, STEP = slice(0, 5), 0.005
DRAWS, FITTED = (0, 1, 2), 10
PENDULUM = """<robot name="pendulum"><link name="base"/><link name="arm"><inertial><origin xyz="0 0 -0.1"/>
<mass value="0.49"/><inertia ixx="1e-6" ixy="0" ixz="0" iyy="1e-6" iyz="0" izz="1e-6"/></inertial></link>
<joint name="horn" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>
<limit lower="-3.2" upper="3.2" effort="10" velocity="100"/></joint></robot>"""


def main() -> None:
    """Runs both arms of the study and writes result.json, unless --quick."""
    parser = argparse.ArgumentParser(description=__doc__)
    told = "of the rival on SO-101, draw by draw, the last number for all further draws"
    parser.add_argument("--evaluations", type=int, nargs="+", default=[1500], help=told)
    parser.add_argument("--quick", action="store_true", help="one servo and a short rival; nothing is written")
    given = parser.parse_args()
    result: dict[str, Any] = {"xl330": _xl330(60 if given.quick else 2500), "so101": []}
    for draw, seed in enumerate(() if given.quick else DRAWS):
        evaluations = given.evaluations[min(draw, len(given.evaluations) - 1)]
        result["so101"].append(_so101(seed, evaluations))
        result["pass"] = {
            "so101_error": all(run["rmse_deg"] <= 0.6 for run in result["so101"]),
            "so101_time": all(run["seconds"] <= 180.0 for run in result["so101"]),
            "xl330_error": all(run["mean_absolute_error"] <= 0.040 for run in result["xl330"]),
            "xl330_time": all(run["seconds"] <= 60.0 for run in result["xl330"]),
        }
        text = json.dumps(result, indent=1, allow_nan=False, ensure_ascii=False)
        (HERE / "result.json").write_text(text + "\n", encoding="utf-8")  # after each draw
    print(json.dumps(result, indent=1, allow_nan=False, ensure_ascii=False))


def _so101(seed: int, evaluations: int) -> dict[str, Any]:
    robot = load_description(DATA / "so101" / "so101.xml")
    folders = sorted(path for path in (DATA / "so101").iterdir() if path.is_dir())
    runs = [load_recording(path, robot=robot) for path in folders]
    order = np.random.default_rng(seed).permutation(len(runs))
    fit, held = ([runs[i] for i in part] for part in (order[:FITTED], order[FITTED:]))
    begun, used = time.perf_counter(), time.process_time()
    found = diagnose_motion(fit, robot)
    spent, used = time.perf_counter() - begun, time.process_time() - used
    begun = time.perf_counter()
    rival = fitted_by_search(robot, fit, [1.0] * len(fit), range(5), evaluations, seed, 2.0 * STEP)
    out = {
        "seed": seed,
        "seconds": spent,
        "processor_seconds": used,
        "rival_seconds": time.perf_counter() - begun,
        "evaluations": evaluations,
    }
    for key, model in (("rmse_deg", found.corrected), ("nominal_deg", found.nominal), ("rival_deg", rival)):
        errors = np.concatenate([rolled(model, r, 1.0, STEP)[:, ARM] - r.q[:, ARM] for r in held])
        out[key] = float(np.degrees(np.sqrt(np.mean(errors**2))))
    return out | {"effects": _told(found)}


def _xl330(evaluations: int) -> list[dict[str, Any]]:
    path = HERE / "pendulum.urdf"
    path.write_text(PENDULUM, encoding="utf-8")
    robot = load_description(path)
    path.unlink()
    files = sorted((DATA / "bam_xl330").glob("*.json"))
    logs = [(json.loads(f.read_text())["kp"], load_recording(f, robot=robot)) for f in files]
    return [_split(robot, logs, fitted, evaluations) for fitted in ((100, 800), (200,))]


def _split(
    robot: Any, logs: Sequence[tuple[int, Recording]], fitted: Sequence[int], evaluations: int
) -> dict[str, Any]:
    fit = [(kp / 100.0, log) for kp, log in logs if kp in fitted]
    held = [(kp / 100.0, log) for kp, log in logs if kp not in fitted]
    gains, recordings = [gain for gain, _ in fit], [log for _, log in fit]
    begun, used = time.perf_counter(), time.process_time()
    found = diagnose_motion(recordings, robot, gains=gains)
    spent, used = time.perf_counter() - begun, time.process_time() - used
    begun = time.perf_counter()
    rival = fitted_by_search(robot, recordings, gains, [0], evaluations, 0, STEP)
    out: dict[str, Any] = {"fitted_on": list(fitted), "seconds": spent, "processor_seconds": used}
    out["rival_seconds"] = time.perf_counter() - begun
    for key, model in (("mean_absolute_error", found.corrected), ("rival", rival)):
        out[key] = float(np.mean([np.abs(rolled(model, log, gain, 0.002) - log.q).mean() for gain, log in held]))
    return out | {"evaluations": evaluations, "effects": _told(found)}


def _told(found: Any) -> list[dict[str, Any]]:
    return [
        {
            "joint": e.joint,
            "effect": e.effect,
            "tied_with": list(e.tied_with),
            "parameters": {p.name: [p.value, p.unit, *p.ci95] for p in e.parameters},
        }
        for e in found.effects
    ]


if __name__ == "__main__":
    main()
