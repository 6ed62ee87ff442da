"""Whether a new effect of a joint can be followed: each recording must determine it beside what is followed already.

A search compares effects on one recording and names what predicts best there. To be followed over time an effect must
do more: fitted together with the set it must be told apart from it in nearly every recording, also in those that show
nothing of it. Else its parameter and those of the set trade with each other from recording to recording, and changes
are told where nothing changed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from lagnet.servos.catalogue import servo_effect
from lagnet.servos.parameters import INDEX
from lagnet.tracking.servos.new_physics import Candidate
from lagnet.tracking.tracked_set import SUPPORT

WIDER = 1.5  # times as wide as without it may an interval be: correlations up to 0.75, the worth of 5 recordings in 9
ENOUGH = 0.8  # of a robot's recordings must determine it
KNOWN = "its parameters are followed already under another name"

Fits = Sequence[Mapping[str, Any]]  # what fits of recordings told, `error` alone where one failed


def why_not_shown(one: Candidate, fits: Fits) -> str | None:
    """None if recordings that name an effect show it also when it is fitted with the set, else why not.

    Args:
        one: the effect.
        fits: of a set that holds it, to the recordings that name it.
    """
    found = [_told_of(one, fit) for fit in fits]
    if any(told is not None and not told["values"] for told in found):
        return KNOWN
    shown = sum(told is not None and _excludes_absence(one, told) for told in found)
    if shown >= min(SUPPORT, len(fits)):
        return None
    return f"fitted with what is followed, its interval excludes its absence in {shown} of the {len(fits)} that name it"


def why_not_determined(one: Candidate, fits: Fits, where: str = "recordings") -> str | None:
    """None if enough recordings determine an effect beside the set, else why they do not.

    Args:
        one: the effect.
        fits: of a set that holds it.
        where: what was fitted, in words.
    """
    fine = [fit for fit in fits if "rows" in fit]
    found = [_told_of(one, fit) for fit in fine]
    if any(told is not None and not told["values"] for told in found):
        return KNOWN
    apart = [told is not None and _is_apart(told) for told in found]
    narrow = [told is not None and _is_narrow(one, told) for told in found]
    share = sum(a and n for a, n in zip(apart, narrow, strict=True)) / max(1, len(fine))
    if share >= ENOUGH:
        return None
    reasons = []
    if sum(apart) < ENOUGH * len(fine):
        reasons.append(f"{len(fine) - sum(apart)} of {len(fine)} {where} do not tell it from what is followed")
    if sum(narrow) < ENOUGH * len(fine) or not reasons:
        reasons.append(f"{len(fine) - sum(narrow)} of {len(fine)} {where} would not show it by its size")
    return "; ".join(reasons)


def cost(one: Candidate, fits: Fits) -> float:
    """Median factor by which it widens intervals; infinite where recordings do not tell it apart at all."""
    found = [_told_of(one, fit) for fit in fits if "rows" in fit]
    wider = sorted(float("inf") if told is None or told["wider"] is None else told["wider"] for told in found)
    return wider[len(wider) // 2] if wider else float("inf")


def _told_of(one: Candidate, fit: Mapping[str, Any]) -> Mapping[str, Any] | None:
    told = fit.get("determined", ())
    return next((d for d in told if (d["joint"], d["effect"]) == (one.joint, one.effect)), None)


def _is_apart(told: Mapping[str, Any]) -> bool:
    return told["wider"] is not None and told["wider"] <= WIDER


def _excludes_absence(one: Candidate, told: Mapping[str, Any]) -> bool:
    return any(abs(v - one.absent[INDEX[n]]) > told["halves"][n] > 0.0 for n, v in told["values"].items())


def _is_narrow(one: Candidate, told: Mapping[str, Any]) -> bool:
    """Whether an interval is narrower than the size at which searches found the effect."""
    sizes = _sizes(one)
    return any(0.0 < half < sizes.get(name, 0.0) for name, half in told["halves"].items())


def _sizes(one: Candidate) -> dict[str, float]:
    """How far its law parameters, as searches found them, lie from those of the set."""
    law = servo_effect(one.effect)
    pairs = zip(law.parameters, law.frees, strict=True)
    return {names[0]: abs(one.values[p.name] - one.absent[INDEX[names[0]]]) for p, names in pairs}
