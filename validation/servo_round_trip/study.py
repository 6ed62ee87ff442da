"""Every cause that motion can show through every engine and back, on an arm driven by position commands.

python -m validation.servo_round_trip.study [--quick] [--only CAUSE ...]

With --only the other rows of result.json stay as they are.
"""

from __future__ import annotations

import argparse
import json
import sys
from importlib.metadata import version
from pathlib import Path

from lagnet.rigid_body.random_arm import random_arm
from lagnet.rigid_body.robot import Robot
from lagnet.simulators.round_trips.round_trip import size_of
from lagnet.simulators.round_trips.servo_cases import SERVO_CASES, commands, plain_model, servo_case, start_of
from lagnet.simulators.round_trips.servo_round_trip import rolled_out, servo_engine_motion
from lagnet.simulators.servo_exporters.registry import SERVO_EXPORTERS
from validation.round_trip.study import LINE, MEASURED

FILE = Path(__file__).resolve().parent / "result.json"
QUICK = ("gain_error", "command_delay", "directional_load_friction", "dead_band")
NAMES = (*SERVO_CASES, "surface_contact")
PATHS = (("mjcf", "mujoco"), ("pybullet", "pybullet"))
STEP = 1e-4


def rows_of(robot: Robot, name: str, seconds: float, step: float) -> list[dict]:
    """One row for each engine that has a place for the cause."""
    time, sent = commands(seconds)
    given = (time, sent, start_of(robot))
    without = rolled_out(plain_model(robot), *given)
    model = servo_case(robot, name, without)
    wanted = rolled_out(model, *given)
    contribution, rows = size_of(wanted - without), []
    for exporter, engine in PATHS:
        status = SERVO_EXPORTERS[exporter].places[name].status
        if status == "not_representable":
            continue
        share = size_of(servo_engine_motion(model, exporter, engine, given, step) - wanted) / contribution
        row = {"cause": name, "exporter": exporter, "engine": engine, "status": status}
        rows.append(row | {"share": float(f"{share:.3g}"), "contribution_rad": float(f"{contribution:.3g}")})
        print(f"{name:28s} {exporter:9s} {status:12s} {100 * share:8.3f} %", flush=True)
    return rows


def main() -> int:
    """Run, judge, and write where nothing was left out."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", nargs="*")
    options = parser.parse_args()
    robot = random_arm(3, seed=5, kinds=("revolute",), fixed=False)
    names = tuple(options.only or ()) or (QUICK if options.quick else NAMES)
    seconds, step = (2.0, 2 * STEP) if options.quick else (6.0, STEP)
    rows = [row for name in names for row in rows_of(robot, name, seconds, step)]
    worst = max((r["share"] for r in rows if r["status"] == "exact"), default=0.0)
    line = 2 * LINE if options.quick else LINE  # at twice the step
    print(f"worst of the exact ones: {100 * worst:.2f} % (line {100 * line:g} %)")
    if not options.quick:
        write([*kept(names), *rows])
    return 0 if worst < line else 1


def kept(names: tuple[str, ...]) -> list[dict]:
    """Rows of the last result for causes that were not run now."""
    rows = json.loads(FILE.read_text(encoding="utf-8"))["rows"] if FILE.exists() else []
    return [row for row in rows if row["cause"] not in names]


def write(rows: list[dict]) -> None:
    """The result, and the table that the package carries."""
    rows = sorted(rows, key=lambda r: NAMES.index(r["cause"]))
    worst = max(r["share"] for r in rows if r["status"] == "exact")
    engines = {name: version(name) for name in ("mujoco", "pybullet")}
    result = {"engines": engines, "worst_exact": worst, "line": LINE, "passed": worst < LINE, "rows": rows}
    FILE.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    table: dict[str, dict[str, dict[str, float]]] = {}
    for row in rows:
        table.setdefault(row["exporter"], {}).setdefault(row["cause"], {})[row["engine"]] = row["share"]
    measured = json.loads(MEASURED.read_text(encoding="utf-8")) | {"engines": engines, "servo_shares": table}
    MEASURED.write_text(json.dumps(measured, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
