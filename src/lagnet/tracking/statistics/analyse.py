"""All parameters of a fleet over time: which changed and when, which stand apart from their sisters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

import numpy as np
from scipy.stats import false_discovery_control

from lagnet.tracking.statistics.change_points import Change, levels, outliers, scan
from lagnet.tracking.statistics.covariates import THERMOMETER, CovariateModel, fit_covariates
from lagnet.tracking.statistics.followed_law import stage_of
from lagnet.tracking.statistics.pooling import pool
from lagnet.tracking.statistics.series import NORMAL, Observation, Series, series_of

MOST_CHANGES = 4  # of one parameter of one robot
ODD_RATE = 0.05  # of false discoveries among robots that stand apart: a hint to look, where a change is a claim


@dataclass(frozen=True)
class Event:
    """A change of a parameter that temperature and load do not explain.

    Args:
        robot, make, joint, effect, parameter, unit: what changed; joint None for the whole arm.
        kind: step or drift.
        date: of the first recording that shows it; of a drift, when it sets in.
        earliest, latest: between which the date lies with 95 %.
        change, lower, upper: with its 95 % interval: relative where `relative`, else in the unit.
        p_value: before the correction for many tests.
        temperature_known: whether temperature was taken into account; where not, it may be the cause.
    """

    robot: str
    make: str
    joint: str | None
    effect: str
    parameter: str
    unit: str
    kind: str
    date: datetime
    earliest: datetime
    latest: datetime
    change: float
    lower: float
    upper: float
    relative: bool
    p_value: float
    temperature_known: bool


@dataclass(frozen=True)
class Standing:
    """Where a robot stands among its sisters, at usual temperature and load, after its last change.

    Args:
        robot, make, joint, effect, parameter, unit: what it is about.
        value, lower, upper: at the last recording, with the 95 % interval.
        pooled: drawn towards the sisters by its uncertainty.
        family, family_lower, family_upper: middle of the family and where 95 % of it lie; None where there is none.
        out_of_family: whether it stands apart.
        p_value: before the correction for many tests.
        by_temperature, by_load: range over the recordings of what these two explain, as `Event.change`.
        relative: whether the last two are relative.
    """

    robot: str
    make: str
    joint: str | None
    effect: str
    parameter: str
    unit: str
    value: float
    lower: float
    upper: float
    pooled: float
    family: float | None
    family_lower: float | None
    family_upper: float | None
    out_of_family: bool
    p_value: float
    by_temperature: float
    by_load: float
    relative: bool


@dataclass(frozen=True)
class Adjusted:
    """An observation brought to usual temperature and load; `outlier` where it was left out of the tests."""

    observation: Observation
    value: float
    outlier: bool


@dataclass(frozen=True)
class Analysis:
    """What became of a fleet."""

    events: tuple[Event, ...]
    standings: tuple[Standing, ...]
    adjusted: tuple[Adjusted, ...]


@dataclass(eq=False)
class _Case:
    """A series under test: less its outliers, with the changes accepted so far."""

    whole: Series
    series: Series
    model: CovariateModel
    outliers: tuple[int, ...]
    changes: list[Change]
    candidate: Change | None


def analyse(observations: Sequence[Observation], rate: float = 0.01, thermometer: float = THERMOMETER) -> Analysis:
    """Changes and odd robots, with the expected share of wrong ones among each kept low.

    Args:
        observations: followed parameters of all robots and recordings.
        rate: of false discoveries among changes, over all robots, joints and parameters. Source: benjamini1995.
        thermometer: standard deviation between the temperature told and that of the joint's friction [K].
    """
    cases = []
    for group in series_of(observations).values():
        model = fit_covariates(group, thermometer)
        for series in group:
            odd = outliers(series, model)
            clean = series.without(odd)
            cases.append(_Case(series, clean, model, odd, [], scan(clean, model)))
    _accept(cases, rate)
    events = [e for case in cases for e in _events(case)]
    adjusted = [a for case in cases for a in _adjusted(case)]
    events.sort(key=lambda e: (e.date, e.robot, e.joint or "", e.effect, e.parameter))
    return Analysis(tuple(events), tuple(_standings(cases, ODD_RATE)), tuple(adjusted))


def _accept(cases: Sequence[_Case], rate: float) -> None:
    """Accepts changes up to the limit on p that keeps the rate, then further ones of the same series up to it."""
    tested = [c for c in cases if c.candidate is not None]
    if not tested:
        return
    p = np.array([c.candidate.p_value for c in tested if c.candidate is not None])
    told = p[false_discovery_control(p) <= rate]
    limit = float(told.max()) if told.size else -1.0
    for case in tested:
        while case.candidate is not None and case.candidate.p_value <= limit and len(case.changes) < MOST_CHANGES:
            case.changes.append(case.candidate)
            case.candidate = scan(case.series, case.model, case.changes)


def _scale(case: _Case, size: float) -> float:
    return float(np.expm1(size)) if case.whole.logarithmic else float(size)


def _value(case: _Case, value: float) -> float:
    return float(np.exp(value)) if case.whole.logarithmic else float(value)


def _name(case: _Case) -> dict[str, Any]:
    first = case.whole.observations[0]
    return {n: getattr(first, n) for n in ("robot", "make", "joint", "effect", "parameter", "unit")}


def _events(case: _Case) -> list[Event]:
    rows, needs = case.series.observations, stage_of(case.whole.group[2]) != "body"
    known = not needs or bool(np.isfinite(case.whole.temperature).all())
    out = []
    for c in case.changes:
        half = NORMAL * c.sigma
        sizes = [_scale(case, s) for s in (c.size, c.size - half, c.size + half)]
        dates = [rows[i].date for i in (c.index, c.earliest, c.latest)]
        when: dict[str, Any] = dict(zip(("date", "earliest", "latest"), dates, strict=True))
        size: dict[str, Any] = dict(zip(("change", "lower", "upper"), sizes, strict=True))
        told: dict[str, Any] = {"relative": case.whole.logarithmic, "p_value": c.p_value, "temperature_known": known}
        out.append(Event(**_name(case), kind=c.kind, **when, **size, **told))
    return out


def _adjusted(case: _Case) -> list[Adjusted]:
    found = levels(case.series, case.model, case.changes)
    left_out = set(case.outliers)
    explained = np.zeros((case.whole.days.size, 2))
    explained[[i for i in range(len(explained)) if i not in left_out]] = found.explained
    return [
        Adjusted(o, o.value if i in left_out else _value(case, v - e), i in left_out)
        for i, (o, v, e) in enumerate(
            zip(case.whole.observations, case.whole.value, explained.sum(axis=1), strict=True)
        )
    ]


def _standings(cases: Sequence[_Case], rate: float) -> list[Standing]:
    groups: dict[Any, list[_Case]] = {}
    for case in cases:
        groups.setdefault(case.whole.group, []).append(case)
    out, p = [], []
    for group in groups.values():
        found = [levels(c.series, c.model, c.changes) for c in group]
        level, sigma = np.array([f.last for f in found]), np.array([f.sigma_last for f in found])
        family = pool(level, sigma, rate)
        single = bool(np.all(family.p_value == 1.0))
        edges = [family.mean + k * NORMAL * family.spread for k in (0, -1, 1)]
        for case, here, pooled, p_value in zip(group, found, family.pooled, family.p_value, strict=True):
            middle, low, high = (None, None, None) if single else (_value(case, e) for e in edges)
            half = NORMAL * here.sigma_last
            ranges = [_scale(case, float(np.ptp(here.explained[:, k]))) for k in range(2)]
            value, lower, upper = (_value(case, here.last + k * half) for k in (0, -1, 1))
            names = ("family", "family_lower", "family_upper", "by_temperature", "by_load", "value", "lower", "upper")
            told: dict[str, Any] = dict(zip(names, (middle, low, high, *ranges, value, lower, upper), strict=True))
            told |= {"pooled": _value(case, pooled), "p_value": float(p_value), "relative": case.whole.logarithmic}
            out.append(Standing(**_name(case), **told, out_of_family=False))
            p.append(float(p_value))
    odd = false_discovery_control(p) <= rate if p else []
    return [Standing(**{**vars(s), "out_of_family": bool(o)}) for s, o in zip(out, odd, strict=True)]
