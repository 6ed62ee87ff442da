"""Sentences of a verdict on motion that an engineer can act on."""

from __future__ import annotations

from collections.abc import Sequence
from math import exp

from lagnet.diagnosis.verdict.verdict import NamedParameter
from lagnet.percent import percent
from lagnet.servos.catalogue import SERVO_CATALOGUE, servo_effect

RATIOS = {"N m": "rad", "N m/rad": "", "N m s/rad": "s", "kg m²": "s²", "N m s²/rad²": "s²/rad"}
PER_LOAD = {"load_driving": "rad/(N m)", "load_driven": "rad/(N m)", "load_squared": "rad/(N m)²"}  # of a given load


def explain_effect(
    name: str,
    joint: str,
    parameters: Sequence[NamedParameter],
    tied: Sequence[str],
    gain: float,
    nominal: dict[str, float],
) -> str:
    """Effect, joint, parameters with nominal values, and the change of the error of held-out rollouts."""
    law = servo_effect(name)
    shown = ", ".join(
        f"{p.name} = {p.value:.4g} {p.unit}".rstrip(" –")
        + (f" (nominal {nominal[p.name]:.4g})" if nominal.get(p.name) else "")
        for p in parameters
    )
    text = f"{law.title} at {joint}, {law.formula} with {shown}: without it errors of position on motion that was not "
    text += f"fitted are {percent(exp(gain) - 1.0)} larger."
    if tied:
        names = " or ".join(t.replace("_", " ") for t in tied)
        text += f" These recordings cannot tell it from {names}. What would: a recording that {separating(name, tied)}."
    return text


def separating(name: str, tied: Sequence[str]) -> str:
    """The motions that excite the effect and its rivals."""
    shown = [servo_effect(n).shown_by for n in (name, *tied) if n in SERVO_CATALOGUE]
    return " and ".join(dict.fromkeys(shown))


def as_ratio(parameter: NamedParameter, kp: float, law_parameter: str = "") -> NamedParameter:
    """p/kp of a torque, where nothing determines its scale in N m; lengths and times stay.

    Friction per load is a torque as well: the loads are those of the given bodies, whatever kp is.

    Args:
        parameter: as it is told.
        kp: gain of the law [N m/rad].
        law_parameter: the law parameter behind it, the first where there are several.
    """
    units = RATIOS | {parameter.unit: PER_LOAD[law_parameter]} if law_parameter in PER_LOAD else RATIOS
    if parameter.unit not in units or parameter.name == "kp":
        return parameter
    low, high = parameter.ci95
    return NamedParameter(f"{parameter.name}/kp", parameter.value / kp, units[parameter.unit], (low / kp, high / kp))
