"""What is in the effort column? Simulated logs of twelve kinds, the real ones, and a rule of thumb beside."""

from __future__ import annotations

import argparse
import json
import os
import time
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import lagnet
from lagnet.diagnosis.effort_column.decide import effort_column
from lagnet.diagnosis.effort_column.finding import CANNOT_TELL, EffortFinding
from lagnet.recordings.loading.load import load_recording
from lagnet.recordings.loading.opening import open_source
from lagnet.recordings.recording import Recording
from validation.effort_column.logs import KINDS, TRUE, Log, make_log

HERE = Path(__file__).parent
EACH, SEED = 5, 57
PENDULUM = """<robot name="pendulum"><link name="base"/>
<link name="arm"><inertial><origin xyz="0 -0.1 0"/><mass value="0.49"/>
<inertia ixx="1e-5" iyy="1e-5" izz="1e-5" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="joint_0" type="revolute"><parent link="base"/><child link="arm"/>
<origin xyz="0 0 0" rpy="1.5707963 0 0"/><axis xyz="0 0 1"/>
<limit lower="-3.2" upper="3.2" effort="0.6" velocity="11"/></joint></robot>"""


def grade(kind: str, unit: str, true_kind: str, true_unit: str) -> str:
    """right, wrong or undecided."""
    if kind == CANNOT_TELL:
        return "undecided"
    if kind == "torque of either side":
        fits = true_kind in ("torque", "link-side torque") and unit == true_unit
        return "undecided" if fits else "wrong"
    if kind == "magnitude":
        return "right" if true_kind.startswith("magnitude") else "wrong"
    if {kind, true_kind} == {"duty", "position error"}:
        return "right"
    return "right" if kind == true_kind and (not true_unit or unit in (true_unit, "")) else "wrong"


def truth(kind: str) -> tuple[str, str]:
    """The kind and unit that must be stated; "" where a kind has no unit."""
    units = {"current": "drive's own", "magnitude of current": "drive's own", "duty": "drive's own"}
    if kind in TRUE:
        return TRUE[kind]
    return kind, units.get(kind, "N m" if "torque" in kind else "")


def rule_of_thumb(log: Log) -> tuple[str, str]:
    """By size alone."""
    y, rec = np.asarray(log.recording.tau), log.recording
    nominal = log.robot.gravity_torque(rec.q)
    factor = float(np.median(y.std(axis=0) / np.maximum(nominal.std(axis=0), 1e-3 * nominal.std())))
    if (y >= 0).all():
        return "magnitude", ""
    return (
        ("torque", "N m")
        if 0.5 < factor < 2
        else ("torque", "N mm")
        if 500 < factor < 2000
        else ("current", "drive's own")
    )


def simulated(each: int, seed: int) -> list[dict[str, Any]]:
    """One row a log."""
    rows = []
    for kind in KINDS:
        for k in range(each):
            log = make_log(kind, seed + k)
            found = effort_column([log.recording], log.robot)
            rows.append(row(kind, f"{log.arm} {k}", found, truth(kind)))
            rows[-1]["rule_of_thumb"] = grade(*rule_of_thumb(log), *truth(kind))
            print(f"{kind:24} {log.arm:8} {found.kind:24} {found.unit:12} {rows[-1]['grade']}", flush=True)
    return rows


def row(kind: str, name: str, found: EffortFinding, true: tuple[str, str]) -> dict[str, Any]:
    """A finding against the truth."""
    said = {"found": found.kind, "unit": found.unit, "because": found.evidence[-1]}
    return {"true": kind, "log": name, **said, "grade": grade(found.kind, found.unit, *true)}


def real(data: Path) -> list[dict[str, Any]]:
    """The real logs."""
    rows = []

    def judge(name: str, recording: Recording, robot: Any, kind: str, column: str = "tau") -> None:
        found = effort_column([recording], robot, column)
        rows.append(row(kind, name, found, truth(kind)))
        print(f"{name:24} {found.kind:24} {found.unit:12} {rows[-1]['grade']}", flush=True)

    for name, file, kind in (
        ("ur10", "bags/ur10_exciting_trajectory.db3", "torque"),
        ("panda", "bags/panda_exciting_trajectory.db3", "link-side torque"),
        ("panda", "panda/fit.csv.gz", "link-side torque"),
        (str(data / "staubli_tx40" / "tx40.urdf"), "staubli_tx40/fit.csv.gz", "torque"),
        (str(data / "emps" / "emps.urdf"), "emps/fit.csv.gz", "torque"),
    ):
        robot = lagnet.load_robot(name)
        judge(file, load_recording(data / file, robot=robot), robot, kind)
    robot = lagnet.load_robot(str(data / "ur10e" / "ur10e.urdf"))
    for file in (
        "ur10e/fit_0.csv.gz",
        "ur10e/holdout.csv.gz",
        "ur10e_loaded/loaded_0.csv.gz",
        "ur10e_loaded/loaded_1.csv.gz",
    ):
        judge(file, load_recording(data / file, robot=robot, torque_constant=1.0), robot, "current", "current")
    real_servos(data, judge)
    return rows


def real_servos(data: Path, judge: Any) -> None:
    """Duty cycles of a servo bench and magnitudes of SO-101."""
    pendulum = _from_text(PENDULUM)
    for file in sorted((data / "bam_xl330").glob("*.json")):
        recording = load_recording(file, robot=pendulum)
        off = np.flatnonzero(np.asarray(recording.enabled)[:, 0] < 0.5)
        kept = recording.rows(slice(0, int(off[0]) if off.size else len(recording)))
        judge(f"bam_xl330/{file.name}", kept, pendulum, "duty", "duty")
    robot = lagnet.load_robot(str(data / "so101" / "so101.urdf"))
    for name in ("multisine", "chirp_sweep", "hold_under_gravity", "large_amplitude", "prbs_excitation"):
        recording = load_recording(data / "so101" / name, robot=robot)
        columns: Any = open_source(data / "so101" / name)[0]
        size = np.stack([columns.columns[f"torques_magnitude_{i}"] for i in range(6)], axis=1)
        judge(f"so101/{name}", replace(recording, tau=size), robot, "magnitude of current")


def _from_text(text: str) -> Any:
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "pendulum.urdf"
        path.write_text(text)
        return lagnet.load_robot(str(path))


def summary(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """Counts."""
    grades = Counter(r["grade"] for r in rows)
    baseline = Counter(r["rule_of_thumb"] for r in rows if "rule_of_thumb" in r)
    decided = 1.0 - grades["undecided"] / max(len(rows), 1)
    return {"logs": len(rows), "decided": decided, **{g: grades[g] for g in ("right", "wrong", "undecided")}} | (
        {"rule_of_thumb": dict(baseline)} if baseline else {}
    )


def main() -> None:
    """Run the study."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--seed", type=int, default=SEED)
    options = parser.parse_args()
    start, folder = time.time(), os.environ.get("LAGNET_DATA_DIR")
    rows = simulated(1 if options.quick else EACH, options.seed)
    result: dict[str, Any] = {"seed": options.seed, "simulated": summary(rows)}
    if folder and not options.quick:
        of_real = real(Path(folder))
        result |= {"real": summary(of_real), "real_logs": of_real}
    result |= {"simulated_logs": rows}
    passes = result["simulated"]["wrong"] == 0 and result["simulated"]["decided"] >= 0.9
    result["passes"] = bool(passes and result.get("real", {"wrong": 0})["wrong"] == 0)
    told = {k: result[k] for k in ("simulated", "real", "passes") if k in result}
    print(json.dumps(told, indent=1), f"\n{time.time() - start:.0f} s")
    if not options.quick:
        (HERE / "result.json").write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
