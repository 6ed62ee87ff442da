"""Contact with a surface in the verdict on motion: its entry among the effects, or why the correction alone has it."""

from __future__ import annotations

from lagnet.diagnosis.motion.joint.block_scores import log10_odds
from lagnet.diagnosis.motion.surface.evidence import LEAST_JOINTS
from lagnet.diagnosis.motion.surface.found import SurfaceFound
from lagnet.diagnosis.verdict.verdict import Abstained, EffectEvidence, EffectFound, NamedParameter
from lagnet.percent import percent

NAME = "surface_contact"


def surface_effects(found: SurfaceFound | None) -> list[EffectFound]:
    """One effect of the whole arm, the surface's height and what touches it; none where it is no claim."""
    if found is None or not found.named:
        return []
    units = dict.fromkeys(("h", "px", "py", "pz"), "m") | {"mu": ""} | ({"k": "N/m"} if found.scale_is_set else {})
    parameters = tuple(NamedParameter(n, found.values[n], unit, found.intervals[n]) for n, unit in units.items())
    text = f"Contact with a level surface {_place(found)}: the arm rests on it where its command would take it below. "
    text += f"Without it errors of position there, on motion that was not fitted, are {_larger(found)} larger."
    evidence = EffectEvidence(*found.power, found.share, None, log10_odds(found.errors))
    return [EffectFound(NAME, None, "named", (), parameters, evidence, text)]


def surface_abstentions(found: SurfaceFound | None) -> list[Abstained]:
    """Where the correction holds a surface that is no claim."""
    if found is None or found.named:
        return []
    why = (
        f"the correction rests the arm on a level surface {_place(found)}; without it errors there, on motion that was "
    )
    why += f"not fitted, are {_larger(found)} larger, but "
    if found.pushed < LEAST_JOINTS:
        why += "it pushes one joint alone, as a stop or any torque over that joint's angle does"
    else:
        why += "not in enough places to be told from other causes"
    return [
        Abstained(NAME, None, why, "lower the arm slowly onto the surface in several places, and the same above it")
    ]


def _place(found: SurfaceFound) -> str:
    h, low, high = found.values["h"], *found.intervals["h"]
    where = f"at h = {h:.4g} m over the base's origin (95 %: {low:.4g} to {high:.4g} m)"
    return f"{where}, with a point that moves with {found.joint}"


def _larger(found: SurfaceFound) -> str:
    before, after = found.power
    return percent((before / max(after, 1e-300)) ** 0.5 - 1.0)
