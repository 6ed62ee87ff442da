"""What was told of a fleet against the envelope."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from typing import Any

from lagnet.tracking.statistics.analyse import Event
from lagnet.tracking.track import Track
from validation.fleet.arms import MAKES

FRICTION = (
    "coulomb_friction",
    "viscous_friction",
    "asymmetric_friction",
    "stribeck_friction",
    "load_dependent_friction",
)
CHANGED = ("wear", "tool", "gain")


def score(truth: Sequence[dict[str, Any]], result: Track) -> dict[str, Any]:
    """Shares found and wrongly told, dates, and the odd robot."""
    by_robot: dict[str, list[Event]] = {r["name"]: [] for r in truth}
    for event in result.analysis.events:
        by_robot[event.robot].append(event)
    changed = [r for r in truth if r["fate"]["kind"] in CHANGED]
    others = [r for r in truth if r["fate"]["kind"] not in CHANGED]
    right = {r["name"]: [e for e in by_robot[r["name"]] if is_right(r, e)] for r in changed}
    apart = {(s.robot, s.joint) for s in result.analysis.standings if s.out_of_family}
    odd = [r for r in truth if r["fate"]["kind"] == "odd"]
    warm = [r for r in truth if r["fate"]["kind"] == "warm"]
    wrong_pairs, pairs = _pairs(truth, by_robot)
    dates = {n: min(late(_robot(truth, n), e) for e in events) for n, events in right.items() if events}
    return {
        "found": sum(map(bool, right.values())) / len(changed),
        "missed": [n for n, events in right.items() if not events],
        "wrong_robots": sum(bool(by_robot[r["name"]]) for r in others) / len(others),
        "wrong_joints": wrong_pairs / pairs,
        "worst_date": max((abs(d) for n, d in dates.items()), default=0),
        "dates": dates,
        "warm_told": sum(bool(by_robot[r["name"]]) for r in warm),
        "odd_found": all((r["name"], joint_of(r)) in apart for r in odd),
        "apart": sorted(f"{robot} {joint}" for robot, joint in apart),
    }


def joint_of(robot: dict[str, Any]) -> str | None:
    """Name of the joint that a robot's fate concerns, None for the whole arm."""
    joint = robot["fate"]["joint"]
    return None if joint < 0 else MAKES[robot["make"]][joint][0]


def is_right(robot: dict[str, Any], event: Event) -> bool:
    """Whether an event tells what became of a robot."""
    kind = robot["fate"]["kind"]
    if kind == "tool":
        last = MAKES[robot["make"]][-1][0]
        return event.effect == "payload" or (event.effect == "link_inertia" and event.joint == last)
    if event.joint != joint_of(robot):
        return False
    if kind == "gain":
        return event.effect == "torque_gain" and event.change * robot["fate"]["size"] > 0
    return event.effect in FRICTION and event.change > 0 and event.kind == "drift"


def late(robot: dict[str, Any], event: Event) -> int:
    """Recordings by which the date told comes after the first that shows the change."""
    dates = [datetime.fromisoformat(d) for d in robot["dates"]]
    return dates.index(event.date) - robot["fate"]["since"]


def _pairs(truth: Sequence[dict[str, Any]], told: dict[str, list[Event]]) -> tuple[int, int]:
    """Pairs of robot and joint without a change: wrongly told, and all; a tool may show at the last joint as well."""
    wrong = total = 0
    for robot in truth:
        changed = robot["fate"]["kind"] in CHANGED
        for joint in (None, *(j[0] for j in MAKES[robot["make"]])):
            events = [e for e in told[robot["name"]] if e.joint == joint]
            if changed and joint == joint_of(robot):
                continue
            total += 1
            wrong += any(not (changed and is_right(robot, e)) for e in events)
    return wrong, total


def _robot(truth: Sequence[dict[str, Any]], name: str) -> dict[str, Any]:
    return next(r for r in truth if r["name"] == name)
