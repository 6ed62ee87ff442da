"""Check the arms of example-robot-data; what fails is a finding about a file.

python -m validation.robots.study
"""

from __future__ import annotations

import json
import sys
import time
from importlib.metadata import version
from pathlib import Path
from typing import Any

from lagnet.errors import RobotError
from lagnet.plausibility.quantities.bodies import moving_bodies, reach
from lagnet.plausibility.subject import Subject
from lagnet.plausibility.suite import check
from lagnet.rigid_body.descriptions.named_robots import named_robots
from lagnet.rigid_body.robot import Robot, load_description

HERE = Path(__file__).resolve().parent
MOST_JOINTS, ENOUGH = 16, 10
LIGHT = 1.2  # [kg/m³] air: a body spread so thinly has an inertia that is not its own
IDENTITIES = (
    "mass_matrix_symmetric",
    "mass_matrix_positive_definite",
    "coriolis_quadratic",
    "coriolis_from_mass_matrix",
    "coriolis_skew_symmetric",
    "gravity_is_gradient",
    "torque_without_acceleration",
    "torque_affine_in_acceleration",
    "forward_inverts_inverse",
    "energy_along_motion",
    "energy_along_rollout",
    "periodic_joints",
)


def examine(name: str, robot: Robot) -> dict[str, Any]:
    """One robot: what fails, and the values of the identities."""
    begin = time.perf_counter()
    report = check(robot)
    return {
        "robot": name,
        "joints": robot.n_dof,
        "passed": report.passed,
        "seconds": round(time.perf_counter() - begin, 1),
        "failures": [
            {"check": c.name, "value": c.value, "limit": c.limit, "unit": c.unit, "where": c.where, "said": c.detail}
            for c in report.failures
        ],
        "identities": {n: report[n].value for n in IDENTITIES if report[n].status != "not_applicable"},
        "thin_bodies": _thin(robot),
    }


def _thin(robot: Robot) -> list[dict[str, Any]]:
    """Bodies whose mass would be spread thinner than air: possible, but not what the link looks like."""
    subject, found = Subject(robot), []
    for body in moving_bodies(subject):
        radius = body.radius_of_gyration / 0.6**0.5
        if body.mass > 0 and body.has_inertia and body.mass / (4.18879 * radius**3) < LIGHT:
            gyration = round(body.radius_of_gyration, 4)
            found.append({"link": body.name, "mass_kg": body.mass, "radius_of_gyration_m": gyration})
    return [{**entry, "arm_length_m": round(reach(subject), 3)} for entry in found]


def result() -> dict[str, Any]:
    """All robots that can be read."""
    rows, unread = [], {}
    for name in named_robots():
        try:
            robot = load_description(name)
        except RobotError as error:
            unread[name] = error.what
            continue
        if robot.n_dof > MOST_JOINTS:
            unread[name] = f"{robot.n_dof} joints, more than {MOST_JOINTS}"
            continue
        rows.append(examine(name, robot))
    passing = [row["robot"] for row in rows if row["passed"]]
    broken = sorted({f["check"] for row in rows for f in row["failures"]} & set(IDENTITIES))
    return {
        "study": "robots",
        "pass": len(passing) >= ENOUGH and not broken,
        "example_robot_data": version("example-robot-data"),
        "passing": passing,
        "identities_broken": broken,
        "not_examined": unread,
        "rows": rows,
    }


def findings(found: dict[str, Any]) -> str:
    """The findings as a page."""
    lines = [
        "# Findings in the files of example-robot-data",
        "",
        f"Version {found['example_robot_data']}; written by `python -m validation.robots.study`. "
        f"{len(found['passing'])} robots pass every check: {', '.join(found['passing'])}.",
        "",
        "## Checks that fail",
        "",
        "| robot | link | check | value | limit | what was found |",
        "|---|---|---|---|---|---|",
    ]
    for row in found["rows"]:
        for f in row["failures"]:
            place = (f["where"] or {}).get("link", "–")
            value = "not finite" if f["value"] is None else f"{f['value']:.3g}"
            words = [row["robot"], place, f["check"], f"{value} {f['unit']}", f"{f['limit']:.3g}", f["said"]]
            lines.append("| " + " | ".join(words) + " |")
    lines += [
        "",
        "## Bodies spread thinner than air",
        "",
        "Possible, so no check fails, but not what these links look like: their inertia was made for another body.",
        "",
        "| robot | link | mass [kg] | radius of gyration [m] | length of the arm [m] |",
        "|---|---|---|---|---|",
    ]
    for row in found["rows"]:
        for b in row["thin_bodies"]:
            words = [b["link"], f"{b['mass_kg']:.4g}", f"{b['radius_of_gyration_m']:.3g}", f"{b['arm_length_m']:.3g}"]
            lines.append(f"| {row['robot']} | " + " | ".join(words) + " |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    outcome = result()
    (HERE / "result.json").write_text(json.dumps(outcome, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    (HERE / "findings.md").write_text(findings(outcome), encoding="utf-8")
    print("pass" if outcome["pass"] else "FAIL", len(outcome["passing"]), "pass;", outcome["identities_broken"])
    sys.exit(not outcome["pass"])
