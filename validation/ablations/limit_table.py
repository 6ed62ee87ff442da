"""What is changed of the diagnosis: each limit, to half and to twice its value."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, replace
from typing import Any

from lagnet.diagnosis.rules.catalogue import RULES
from lagnet.diagnosis.settings import DecisionLimits
from validation.ablations.table import Ablation

FACTORS = {"half": 0.5, "twice": 2.0}
RATIOS = {"least_ratio", "above_noise", "lack_of_fit.worse", "impossible_density.least_growth"}
"""Limits of a quotient that is one where nothing differs: what they exceed one by is halved and doubled."""


def name_of(limit: str, change: str) -> str:
    """Of the ablation, such as "tie_odds at half"."""
    return f"{limit} at {change}"


def numbers_of(settings: Any) -> Iterator[tuple[str, float]]:
    """Fields of a settings dataclass that are numbers, with their values."""
    for field in fields(settings):
        value = getattr(settings, field.name)
        if isinstance(value, int | float) and not isinstance(value, bool):
            yield field.name, value


def changed_value(limit: str, value: float, factor: float) -> float:
    """The limit times the factor; of a quotient, one and its excess over one times the factor; integers stay so."""
    new = 1.0 + factor * (value - 1.0) if limit in RATIOS else factor * value
    return round(new) if isinstance(value, int) else new


def _shared() -> Iterator[Ablation]:
    plain = DecisionLimits()
    for limit, value in numbers_of(plain):
        for change, factor in FACTORS.items():
            new = changed_value(limit, value, factor)
            yield Ablation(name_of(limit, change), f"{new:g} for {value:g}", limits=replace(plain, **{limit: new}))


def _of_rules() -> Iterator[Ablation]:
    for rule in RULES:
        plain: Any = rule  # every rule is a frozen dataclass
        for field, value in numbers_of(rule):
            limit = f"{rule.name}.{field}"
            for change, factor in FACTORS.items():
                new = changed_value(limit, value, factor)
                changed = (replace(plain, **{field: new}),)
                yield Ablation(name_of(limit, change), f"{new:g} for {value:g}", changed=changed)


SHARED_LIMITS = tuple(_shared())
LIMITS_OF_RULES = tuple(_of_rules())
