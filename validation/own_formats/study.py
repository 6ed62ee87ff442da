"""Recordings diagnosed straight from the format in which they were published, without a mapping file.

python -m validation.own_formats.study [--quick]
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from validation.motion_real.study import PENDULUM
from validation.own_formats.g1_arms import g1_arms

HERE = Path(__file__).resolve().parent
DATA = Path(os.environ.get("LAGNET_DATA_DIR", HERE.parents[2] / "shared" / "data"))
LIMIT = 900.0  # [s] for one diagnosis


def cases(models: Path) -> dict[str, list[str]]:
    """Arguments of `lagnet diagnose` by name of the set of recordings."""
    (models / "pendulum.urdf").write_text(PENDULUM, encoding="utf-8")
    (models / "g1_arms.urdf").write_text(g1_arms(), encoding="utf-8")
    bags, servo, arm = DATA / "bags", DATA / "bam_xl330", DATA / "so101"
    logs, motions = sorted(servo.glob("*.json")), sorted(p for p in arm.iterdir() if p.is_dir())
    return {
        "XL330 (bench, JSON)": [*map(str, logs), "--robot", str(models / "pendulum.urdf")],
        "UR10 (ROS 2 bag)": [str(bags / "ur10_exciting_trajectory.db3"), "--robot", "ur10"],
        "Panda (ROS 2 bag)": [str(bags / "panda_exciting_trajectory.db3"), "--robot", "panda"],
        "G1, both arms (LeRobot v2.1)": [str(DATA / "lerobot_g1"), "--robot", str(models / "g1_arms.urdf")],
        "SO-101 (30 motion folders)": [*map(str, motions), "--robot", str(arm / "so101.xml")],
    }


def diagnosed(arguments: Sequence[str], out: Path) -> dict[str, Any]:
    """What one command gave: exit code, seconds, names, and errors before and after by joint."""
    begun = time.perf_counter()
    words = [sys.executable, "-m", "lagnet", "diagnose", *arguments, "--out", str(out)]
    ended = subprocess.run(words, capture_output=True, text=True, timeout=LIMIT, check=False)
    found: dict[str, Any] = {"code": ended.returncode, "seconds": round(time.perf_counter() - begun, 1)}
    if ended.returncode:
        return found | {"message": ended.stderr.strip()[-300:]}
    verdict = json.loads((out / "verdict.json").read_text(encoding="utf-8"))
    checker = DATA.parent / "contracts" / "check_outputs.py"
    kept = subprocess.run([sys.executable, str(checker), str(out)], capture_output=True, text=True, check=False)
    return found | summary(verdict) | {"contract": kept.returncode == 0}


def summary(verdict: Mapping[str, Any]) -> dict[str, Any]:
    """Route, names and errors of a verdict: rms of position [rad] on motion, nMSE of torque else."""
    motion = verdict.get("route") == "motion"
    before, after = ("rmse_nominal", "rmse_named") if motion else ("nmse_nominal", "nmse_identified")
    return {
        "route": "motion" if motion else "torque",
        "joints": len(verdict["fit"]),
        "names": [f"{e['effect']} {e['joint']}" for e in verdict["effects"]],
        "before": [float(f"{joint[before]:.3g}") for joint in verdict["fit"]],
        "after": [float(f"{joint[after]:.3g}") for joint in verdict["fit"]],
        "warnings": len(verdict["warnings"]),
        "data_quality": [f["check"] for f in verdict.get("data_quality", [])],
    }


def main() -> None:
    """Runs every set, the first with --quick, or some of them with --only, and writes result.json after each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="the first set alone; nothing is written")
    parser.add_argument("--only", default="", help="a word of the sets' names; the others keep what is written")
    given = parser.parse_args()
    quick, result = given.quick, {}
    if given.only:
        result = json.loads((HERE / "result.json").read_text(encoding="utf-8"))["sets"]
    with tempfile.TemporaryDirectory() as folder:
        for number, (name, arguments) in enumerate(cases(Path(folder)).items()):
            if given.only not in name:
                continue
            result[name] = diagnosed(arguments, Path(folder) / f"out_{number}")
            print(name, json.dumps(result[name], ensure_ascii=False), flush=True)
            if quick:
                break
            passed = all(row["code"] == 0 and row["contract"] for row in result.values())
            text = json.dumps({"passed": passed, "sets": result}, indent=1, ensure_ascii=False, allow_nan=False)
            (HERE / "result.json").write_text(text + "\n", encoding="utf-8")
    if not all(row["code"] == 0 and row["contract"] for row in result.values()):
        raise SystemExit(1)


if __name__ == "__main__":
    main()
