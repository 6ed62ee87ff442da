"""Writes a suggested motion as a recording file, with its expected information, and puts it into words."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from lagnet.diagnosis.identifiability.recording_advice import recording_against
from lagnet.experiment_design.open_ties import OpenTie
from lagnet.experiment_design.suggest_motion import SuggestedMotion
from lagnet.files import finite_json, write_whole
from lagnet.recordings.writing import write_recording

MOTION, EXPECTED = "suggested_motion.csv", "suggested_motion.json"
SCHEMA = "lagnet-suggested-motion/1"
LISTED = 4  # effects that a sentence lists
TAU = "torque that the corrected model expects, not measured"


def write_suggestion(suggested: SuggestedMotion | None, folder: str | Path) -> tuple[Path, ...]:
    """Writes the motion and its expected information; removes those of an earlier diagnosis.

    Args:
        suggested: None, or what is no use, leaves no file.
        folder: of the diagnosis.

    Returns:
        The files written.
    """
    motion, expected = Path(folder) / MOTION, Path(folder) / EXPECTED
    motion.unlink(missing_ok=True)
    expected.unlink(missing_ok=True)
    if suggested is None or not suggested.is_of_use:
        return ()
    write_recording(suggested.recording, motion)
    write_whole(expected, finite_json(content_of(suggested)))
    return motion, expected


def content_of(suggested: SuggestedMotion) -> dict[str, Any]:
    """Plain values: the motion's range at each joint, its limits, and its expected information."""
    recording = suggested.recording
    pairs = zip(suggested.ties, suggested.expectation.separations, strict=True)
    ties = [
        _tie(suggested, tie)
        | {
            "expected_standard_errors": separation.standard_errors,
            "expected_log10_odds": separation.log10_odds,
            "expected_to_break": separation.breaks,
        }
        for tie, separation in pairs
    ]
    never = {"expected_standard_errors": 0.0, "expected_log10_odds": 0.0, "expected_to_break": False}
    return {
        "schema": SCHEMA,
        "motion": MOTION,
        "seed": suggested.seed,
        "duration_s": recording.duration,
        "rate_hz": recording.rate,
        "tau": TAU,
        "limits_from": "model" if suggested.limits.from_model else "recordings",
        "collisions_checked": False,
        "joints": [_joint(suggested, j) for j in range(recording.n_dof)],
        "ties": ties + [_tie(suggested, tie) | never for tie in suggested.unbreakable],
        "abstentions": [
            {"effect": a.effect, "joint": _name(suggested, a.joint), "expected_to_show": shown}
            for a, shown in zip(suggested.abstentions, suggested.expectation.shown, strict=True)
        ],
    }


def _joint(suggested: SuggestedMotion, j: int) -> dict[str, Any]:
    recording, limits = suggested.recording, suggested.limits
    q = recording.q[:, j]
    v, a = (np.zeros_like(q) if x is None else x[:, j] for x in (recording.v, recording.a))
    largest = {"speed": v, "acceleration": a, "torque": recording.torque[:, j]}
    return {
        "joint": recording.joints[j],
        "start": float(q[0]),
        "position": [float(q.min()), float(q.max())],
        "position_limits": [float(limits.lower[j]), float(limits.upper[j])],
    } | {
        key: value
        for name, x in largest.items()
        for key, value in ((name, float(np.abs(x).max())), (f"{name}_limit", float(getattr(limits, name)[j])))
    }


def _tie(suggested: SuggestedMotion, tie: OpenTie) -> dict[str, Any]:
    return {
        "joint": _name(suggested, tie.joint),
        "named": list(tie.instead_of),
        "rivals": list(tie.rivals),
        "recording": recording_against(tie.instead_of, tie.rivals),
    }


def _name(suggested: SuggestedMotion, joint: int | None) -> str | None:
    return None if joint is None else suggested.recording.joints[joint]


def words_of(suggested: SuggestedMotion | None, where: str) -> list[str]:
    """Lines for a terminal: expected information of the motion, ties that no motion breaks, what was not checked."""
    if suggested is None:
        return ["Nothing is open that another motion could settle: none is suggested."]
    lines = [_promise(suggested, tie, k) for k, tie in enumerate(suggested.ties)]
    lines += [
        f"{_pair(suggested, tie)}: {recording_against(tie.instead_of, tie.rivals)}." for tie in suggested.unbreakable
    ]
    lines += _abstentions(suggested)
    if not suggested.is_of_use:
        return [*lines, "No motion within the limits was found that settles any of it: none is suggested."]
    recording, source = suggested.recording, "the model" if suggested.limits.from_model else "the recordings"
    return [
        *lines,
        f"suggested motion: {where}, {recording.duration:.0f} s from rest to rest; move to its first row before.",
        f"It keeps the limits of {source}; collisions of the arm with itself and its surroundings are NOT checked. "
        "Its tau is a forecast: record your own.",
    ]


def _promise(suggested: SuggestedMotion, tie: OpenTie, k: int) -> str:
    separation = suggested.expectation.separations[k]
    distance = f"{separation.standard_errors:.2g} standard errors"
    if separation.breaks:
        return f"{_pair(suggested, tie)}: expected to be told apart, by {distance}."
    advice = recording_against(tie.instead_of, tie.rivals)
    expected = f"not expected to be told apart within the limits ({distance})"
    return f"{_pair(suggested, tie)}: {expected}. It would take {advice}."


def _pair(suggested: SuggestedMotion, tie: OpenTie) -> str:
    first, second = (" with ".join(n.replace("_", " ") for n in names) for names in (tie.instead_of, tie.rivals))
    joint = _name(suggested, tie.joint)
    return f"{first} or {second} {f'at {joint}' if joint else 'on the whole arm'}"


def _abstentions(suggested: SuggestedMotion) -> list[str]:
    if not suggested.abstentions:
        return []
    pairs = list(zip(suggested.abstentions, suggested.expectation.shown, strict=True))
    missed = [f"{a.effect} at {_name(suggested, a.joint) or 'the whole arm'}" for a, shown in pairs if not shown]
    line = f"{len(pairs) - len(missed)} of {len(pairs)} effects that could not be judged are expected to show"
    more = f" and {len(missed) - LISTED} more" if len(missed) > LISTED else ""
    return [f"{line}; not {', '.join(missed[:LISTED])}{more}." if missed else f"{line}."]
