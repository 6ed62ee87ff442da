"""A comparison as lines for the terminal and as `compare.json`."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from math import isfinite
from pathlib import Path
from typing import Any

from lagnet.comparison.advice import Advice
from lagnet.comparison.compare import Comparison
from lagnet.comparison.differences import Difference
from lagnet.comparison.joints import JointComparison
from lagnet.comparison.motion import MotionComparison
from lagnet.rigid_body.descriptions.writing import write_text

SCHEMA, FILE = "lagnet-compare/1", "compare.json"
SHOWN = 12  # differences and pieces of advice on the terminal
DIVERGED = 10.0  # times the scatter: what is not told in figures


def lines(result: Comparison | MotionComparison) -> Iterator[str]:
    """What the terminal says; names of the sets as short as they stay apart."""
    names = short_names(result.names)
    if isinstance(result, MotionComparison):
        yield f"error of rollouts of {result.length:.2g} s: share of the position's variation, with 95 % interval"
        yield from (_line(j, names) for j in result.joints)
        yield f"best: {_summary(result.joints, names)}"
        for joint in result.still:
            yield f"{joint}: does not move in these recordings: not compared"
    else:
        yield "error: share of the torque's variation left, with 95 % interval; offset and friction fitted to each set"
        yield from (_line(j, names) for j in result.joints)
        yield f"best: {_summary(result.joints, names)}"
        if result.as_published is not None:
            yield "as published, with the friction that each set declares instead:"
            yield from (_line(j, names) for j in result.as_published)
            yield f"best as published: {_summary(result.as_published, names)}"
    yield from _parameters(result, names)


def _parameters(result: Comparison | MotionComparison, names: tuple[str, ...]) -> Iterator[str]:
    if result.differences is None:
        yield f"parameters are not compared: {result.reason}"
        return
    resolved = [d for d in result.differences if d.resolved]
    kind = "parameters" if isinstance(result, MotionComparison) else "base parameters, friction and rotors"
    yield f"the sets differ in {len(result.differences)} {kind}; these recordings resolve {len(resolved)}"
    yield from (f"  {d.words(names)}" for d in resolved[:SHOWN])
    if len(resolved) > SHOWN:
        yield f"  and {len(resolved) - SHOWN} more, in {FILE}"
    yield from (f"to record: {entry.words()}" for entry in result.to_record[:SHOWN])
    if len(result.to_record) > SHOWN:
        yield f"to record: for {len(result.to_record) - SHOWN} more see {FILE}"


def short_names(names: Sequence[str]) -> tuple[str, ...]:
    """The last parts of paths, as many as keep the names apart."""
    parts = [Path(n).parts for n in names]
    for count in range(1, max(map(len, parts)) + 1):
        shorter = tuple(str(Path(*p[-count:])) for p in parts)
        if len(set(shorter)) == len(names):
            return shorter
    return tuple(names)


def _line(joint: JointComparison, names: tuple[str, ...]) -> str:
    said = "; ".join(
        f"{name} {_percent(joint.nmse[m])} % [{_percent(joint.interval[m, 0])}, {_percent(joint.interval[m, 1])}]"
        for m, name in enumerate(names)
    )
    return f"{joint.joint}: {_verdict(joint, names)}; error {said}"


def _percent(share: float) -> str:
    return f"{100 * share:.3g}" if share < DIVERGED else f">{100 * DIVERGED:g}"


def _verdict(joint: JointComparison, names: tuple[str, ...]) -> str:
    if joint.alike:
        return "the sets are alike here"
    if len(joint.also) == len(names) - 1:
        return "not decided"
    tied = [names[m] for m in joint.also]
    return f"best {names[joint.best]}" + (f", not told from {', '.join(tied)}" if tied else "")


def _summary(joints: Sequence[JointComparison], names: tuple[str, ...]) -> str:
    """Every set with the joints that it wins alone, then those that are open."""
    told = [j for j in joints if not j.also and not j.alike]
    won = {name: [j.joint for j in told if j.best == m] for m, name in enumerate(names)}
    said = [f"{name} on {', '.join(of)}" for name, of in won.items() if of]
    alike = [j.joint for j in joints if j.alike]
    left = [j.joint for j in joints if j.also and j.joint not in alike]
    said += [f"{what} {', '.join(of)}" for what, of in (("not decided on", left), ("alike on", alike)) if of]
    return "; ".join(said)


def to_json(result: Comparison | MotionComparison) -> dict[str, Any]:
    """Plain data."""
    out: dict[str, Any] = {
        "schema": SCHEMA,
        "route": "motion" if isinstance(result, MotionComparison) else "torque",
        "models": list(result.names),
        "blocks": result.blocks,
        "joints": [_plain_joint(j, result.names) for j in result.joints],
    }
    if isinstance(result, MotionComparison):
        out |= {"rollout_s": result.length, "did_not_move": list(result.still)}
    else:
        own = result.as_published
        out["as_published"] = None if own is None else [_plain_joint(j, result.names) for j in own]
    differing = result.differences
    out["parameters"] = None if differing is None else [_plain_difference(d, result.names) for d in differing]
    out["parameters_missing_because"] = result.reason or None
    out["to_record"] = [{"words": a.words(), "enough": a.is_enough} | _plain_advice(a) for a in result.to_record]
    return out


def _plain_joint(joint: JointComparison, names: tuple[str, ...]) -> dict[str, Any]:
    return {
        "joint": joint.joint,
        "best": names[joint.best],
        "not_told_from_best": [names[m] for m in joint.also],
        "models": [
            {
                "model": name,
                "nmse": float(joint.nmse[m]),
                "ci95": [float(x) for x in joint.interval[m]],
                "above_best_ci95": [float(x) for x in joint.against_best[m]],
            }
            for m, name in enumerate(names)
        ],
    }


def _plain_difference(difference: Difference, names: tuple[str, ...]) -> dict[str, Any]:
    shown, at = isfinite(difference.error), difference.nearest
    return {
        "parameter": difference.parameter,
        "unit": difference.unit,
        "values": {name: float(v) for name, v in zip(names, difference.values, strict=True)},
        "recordings_say": float(difference.estimate) if shown else None,
        "standard_error": float(difference.error) if shown else None,
        "resolved": bool(difference.resolved),
        "agrees_with": None if at is None or not difference.resolved else names[at],
    }


def _plain_advice(entry: Any) -> dict[str, Any]:
    out = {"parameter": entry.parameter, "motion": entry.motion, "joint": entry.joint}
    if isinstance(entry, Advice):
        return out | {"pose_rad": list(entry.pose), "difference_nm": entry.difference, "noise_nm": entry.noise}
    return out | {"difference": entry.difference, "noise": entry.noise}


def write_comparison(result: Comparison | MotionComparison, folder: str | Path) -> Path:
    """Writes `compare.json`."""
    path = Path(folder) / FILE
    write_text(path, json.dumps(to_json(result), indent=1, allow_nan=False) + "\n")
    return path
