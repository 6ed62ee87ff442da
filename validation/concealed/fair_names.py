"""Which claims count as which: one table of rules, set before any diagnosis of this study ran (reasons in README.md).

A claim is `right` where it names a hidden cause on its joint, alone, in a tie of at most three, or by a law whose
torque on these motions is the same within a fifth of the noise. It is `beside` where it is true but not asked for.
Every other claim is `wrong`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from validation.plants.body import joint_names
from validation.plants.catalogue.plan import Plan
from validation.plants.catalogue.unlisted import UNLISTED
from validation.plants.catalogue.witness import Sight, Witness
from validation.plants.spec import Hidden

LARGEST_TIE = 3  # names in a tie, the first included, that still count as an answer
SHARED_TIME = 0.5  # of a passing cause and its claim
FILTER_LAG = 3.0  # a claimed delay may be so many times that of the current filter


@dataclass(frozen=True)
class Claim:
    """One effect of a verdict."""

    effect: str
    joint: str | None
    tied: tuple[str, ...]
    parameters: dict[str, dict]

    @property
    def names(self) -> tuple[str, ...]:
        """The names that it stands for: all of a tie of at most three, else the first."""
        names = (self.effect, *self.tied)
        return names if len(names) <= LARGEST_TIE else names[:1]


def claims_of(verdict: dict) -> list[Claim]:
    """Claims in the verdict's order."""
    return [
        Claim(e["effect"], e["joint"], tuple(e["tied_with"]), {p["name"]: p for p in e["parameters"]})
        for e in verdict["effects"]
    ]


def how_named(hidden: Hidden, sight: Sight, claim: Claim) -> str:
    """ "alone", "tied", "same torque" or "": how a claim names a listed cause."""
    if claim.joint == hidden.joint and claim.effect == hidden.effect:
        return "tied" if claim.tied else "alone"
    if claim.joint == hidden.joint and hidden.effect in claim.names:
        return "tied"
    return "same torque" if any((name, claim.joint) in sight.same_as for name in claim.names) else ""


def _same_time(hidden: Hidden, claim: Claim) -> bool:
    """Whether both last, or both pass and the times that they share are half of the times of either."""
    if "t0" not in hidden.values or "t0" not in claim.parameters:
        return "t0" not in hidden.values and "t0" not in claim.parameters
    first = (hidden.values["t0"], hidden.values["t1"])
    second = (claim.parameters["t0"]["value"], claim.parameters["t1"]["value"])
    shared = min(first[1], second[1]) - max(first[0], second[0])
    return shared >= SHARED_TIME * max(first[1] - first[0], second[1] - second[0])


def match(plan: Plan, witness: Witness, claims: list[Claim]) -> dict[int, tuple[int, str]]:
    """Claims for hidden listed causes, one to one, plainer matches first: cause number → (claim number, how)."""
    pairs: dict[int, tuple[int, str]] = {}
    for wanted in ("alone", "tied", "same torque"):
        for i, (hidden, sight) in enumerate(zip(plan.hidden, witness.sights, strict=True)):
            if i in pairs or hidden.effect.startswith("unlisted:"):
                continue
            for c, claim in enumerate(claims):
                if c not in {taken for taken, _ in pairs.values()} and how_named(hidden, sight, claim) == wanted:
                    pairs[i] = (c, wanted)
                    break
    return pairs


def is_part_of_a_tie(plan: Plan, claim: Claim, paired: dict[int, Claim]) -> bool:
    """Whether a claim is the other half of two that stand, tied, for one hidden cause."""
    for i, other in paired.items():
        cause = plan.hidden[i]
        both = cause.effect in claim.tied and cause.effect in other.tied
        if both and claim.joint == other.joint == cause.joint and len(claim.names) <= LARGEST_TIE:
            return True
    return False


def is_beside(plan: Plan, witness: Witness, claim: Claim) -> bool:
    """Whether a claim that names no hidden cause is true all the same."""
    if "time_delay" in claim.names and plan.current_filter:
        lag = 1 / (2 * np.pi * plan.current_filter)
        return 0 < claim.parameters.get("T", {"value": np.inf})["value"] <= FILTER_LAG * lag
    for hidden, sight in zip(plan.hidden, witness.sights, strict=True):
        kind = UNLISTED.get(hidden.effect.removeprefix("unlisted:"))
        if kind is None or claim.joint not in joints_of(plan, hidden):
            continue
        if any(name in kind.contains for name in claim.names):
            return True
        if any(n in kind.resembles and (n, claim.joint) in sight.resembled_by for n in claim.names):
            return True
        if any(n in kind.resembles and n not in LAWS_COMPARED for n in claim.names):
            return True
    return False


LAWS_COMPARED = ("joint_spring", "quadratic_drag")  # near names whose share of the cause the witness measures


def joints_of(plan: Plan, hidden: Hidden) -> tuple[str | None, ...]:
    """Joints that feel an unlisted cause: its own, and the next one where there is a partner."""
    names = joint_names(plan.robot)
    if hidden.joint is None or not UNLISTED[hidden.effect.removeprefix("unlisted:")].partner:
        return (hidden.joint,)
    j = names.index(hidden.joint)
    return names[j : j + 2] if j + 1 < len(names) else names[j - 1 :]
