"""Every effect through every engine and back.

python -m validation.round_trip.study [--quick] [--only EFFECT ...]

With --only the other rows of result.json stay as they are.
"""

from __future__ import annotations

import argparse
import json
import sys
from functools import partial
from importlib.metadata import version
from pathlib import Path

from lagnet.effects.catalogue import effect_named
from lagnet.rigid_body.random_arm import random_arm
from lagnet.rigid_body.robot import Robot
from lagnet.simulators.corrected_arm.arm_physics import ArmPhysics, arm_physics
from lagnet.simulators.engines.engine import Engine
from lagnet.simulators.engines.registry import engine_of
from lagnet.simulators.registry import EXPORTERS
from lagnet.simulators.round_trips.reference_cases import CASES, COMPANIONS
from lagnet.simulators.round_trips.round_trip import (
    case_of,
    companions_of,
    control_of,
    engine_motion,
    reference_motion,
    size_of,
)
from lagnet.simulators.round_trips.tracking_control import TrackingControl
from lagnet.types import Trajectory

HERE = Path(__file__).resolve().parent
MEASURED = HERE.parents[1] / "src" / "lagnet" / "simulators" / "measured.json"
QUICK = ("coulomb_friction", "stribeck_friction", "rotor_inertia", "payload")
PATHS = (("mjcf", "mujoco"), ("pybullet", "pybullet"), ("urdf", "mujoco"), ("urdf", "pybullet"))
STEP, LINE = 1e-4, 0.01
SMALL = 2e-3  # [rad]: a contribution below it is measured with a quarter of the step, whose own error is 1e-5 rad
JOINT = 1


def opened(exporter: str, engine: str, folder: Path, arm: ArmPhysics, step: float = STEP) -> Engine:
    """The engine at the step of the study."""
    return engine_of(exporter, engine, folder, arm.robot.joints, step)


def rows_of(robot: Robot, name: str, control: TrackingControl, bare: Trajectory, step: float) -> list[dict]:
    """One row for each engine that has a place for the effect."""
    joint = None if effect_named(name).whole_arm else JOINT
    model = case_of(robot, name, joint)
    arm, effect = arm_physics(model), model.effects[-1]
    with_it = reference_motion(arm, control)
    beside = companions_of(robot, name, joint)
    without = reference_motion(arm_physics(beside), control) if name in COMPANIONS else bare
    contribution, rows = size_of(with_it - without), []
    step = step / 4 if contribution < SMALL else step
    for exporter, engine in PATHS:
        place = EXPORTERS[exporter].place(effect)
        if place.status == "not_representable":
            continue
        opener = partial(opened, exporter, engine, step=step)
        moved = engine_motion(EXPORTERS[exporter], arm, opener, control)
        share = size_of(moved - with_it) / contribution
        row = {
            "effect": name,
            "exporter": exporter,
            "engine": engine,
            "status": place.status,
            "share": float(f"{share:.3g}"),
        }
        rows.append(row | {"contribution_rad": float(f"{contribution:.3g}")})
        print(f"\n{name:26s} {exporter:9s} {engine:9s} {place.status:12s} {100 * share:8.3f} %", flush=True)
    return rows


def main() -> int:
    """Run, judge, and write where nothing was left out."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", nargs="*")
    options = parser.parse_args()
    robot = random_arm(3, seed=5, kinds=("revolute",), fixed=False)
    control = control_of(robot, 2.0 if options.quick else 10.0)
    bare = reference_motion(arm_physics(robot), control)
    names = tuple(options.only or ()) or (QUICK if options.quick else tuple(CASES))
    step = 2 * STEP if options.quick else STEP
    rows = [row for name in names for row in rows_of(robot, name, control, bare, step)]
    worst = max((r["share"] for r in rows if r["status"] == "exact"), default=0.0)
    print(f"worst of the exact ones: {100 * worst:.2f} % (line {100 * LINE:g} %)")
    if not options.quick:
        write([*kept(names), *rows])
    return 0 if worst < LINE else 1


def kept(names: tuple[str, ...]) -> list[dict]:
    """Rows of the last result for effects that were not run now."""
    file = HERE / "result.json"
    rows = json.loads(file.read_text(encoding="utf-8"))["rows"] if file.exists() else []
    return [row for row in rows if row["effect"] not in names]


def write(rows: list[dict]) -> None:
    """The result, and the table that the package carries."""
    rows = sorted(rows, key=lambda r: list(CASES).index(r["effect"]))
    worst = max(r["share"] for r in rows if r["status"] == "exact")
    engines = {name: version(name) for name in ("mujoco", "pybullet")}
    result = {"engines": engines, "worst_exact": worst, "line": LINE, "passed": worst < LINE, "rows": rows}
    (HERE / "result.json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    table: dict[str, dict[str, dict[str, float]]] = {}
    for row in rows:
        table.setdefault(row["exporter"], {}).setdefault(row["effect"], {})[row["engine"]] = row["share"]
    measured = json.loads(MEASURED.read_text(encoding="utf-8")) | {"engines": engines, "shares": table}
    MEASURED.write_text(json.dumps(measured, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
