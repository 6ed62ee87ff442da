"""What recordings determine without saying which cause it is: bodies, curves over speed and position, ties."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from lagnet.reports.contents.findings import Findings
from lagnet.reports.figures.joint_curves import FRICTION, OVER_POSITION, joint_curves
from lagnet.reports.page import Section, section
from lagnet.reports.wording import with_interval

SHOWN = 8  # combinations in sight, strongest first; the others are folded
TERMS_SHOWN = 4  # of a combination; verdict.json holds all
COLUMNS = ("dry", "viscous", "load", "rotor", "offset")  # terms of a joint that are parameters by themselves
TIES = {
    "cross_viscous": ("viscous friction of what turns with both", "N m s/rad"),
    "cross_inertia": ("inertia of what turns with both", "kg m²"),
    "cross_dry_sum": ("dry friction of what turns with the sum of both", "N m"),
    "cross_dry_difference": ("dry friction of what turns with the difference of both", "N m"),
}


def build(findings: Findings) -> Section | None:
    """Words, combinations of inertial parameters, curves, ties; None where nothing was identified."""
    found = findings.verdict.get("identified") or {}
    if not any(found.get(part) for part in ("bodies", "joints", "ties")):
        return None
    figures = [joint_curves(findings, found["joints"], kind) for kind in (FRICTION, OVER_POSITION)]
    rows = [_body(entry) for entry in found["bodies"]]
    return section(
        "identified",
        "Identified, not attributed",
        [figure for figure in figures if figure],
        words=found["words"],
        rows=rows[:SHOWN],
        more=rows[SHOWN:],
        joints=[_joint(findings, entry) for entry in found["joints"]],
        ties=[_tie(entry) for entry in found["ties"]],
        open_ones=[_combination(text) for text in found["undetermined"]],
        any_effects=bool(findings.effects),
    )


def _body(entry: Mapping[str, Any]) -> dict[str, Any]:
    return {**entry, **_combination(entry["combination"]), "value": with_interval(entry["change"], *entry["ci95"])}


def _combination(text: str) -> dict[str, str | int]:
    """The first term and those with the largest factors, and how many are left out."""
    parts = re.split(r" (?=[+-] )", text)
    if len(parts) <= TERMS_SHOWN:
        return {"short": text, "whole": text, "left_out": 0}
    strongest = sorted(range(1, len(parts)), key=lambda k: -_factor(parts[k]))[: TERMS_SHOWN - 1]
    short = " ".join([parts[0], *(parts[k] for k in sorted(strongest))])
    return {"short": short, "whole": text, "left_out": len(parts) - TERMS_SHOWN}


def _factor(part: str) -> float:
    """The factor of a term such as "- 0.25 m(link)"; one where none is written."""
    try:
        return float(part[2:].split(" ")[0])
    except ValueError:
        return 1.0


def _joint(findings: Findings, entry: Mapping[str, Any]) -> dict[str, Any]:
    """The terms of a joint that are parameters, with intervals; those that bend its curve are in the picture."""
    evidence = findings.evidence_on(entry["joint"])
    speed, inertia = evidence.velocity_unit, "kg" if evidence.unit == "N" else "kg m²"
    units = {
        "dry": evidence.unit,
        "viscous": f"{evidence.unit} s/{speed.split('/')[0]}",
        "load": "",
        "rotor": inertia,
        "offset": evidence.unit,
    }
    of_kind = {term["term"]: term for term in entry["terms"]}
    cells = [
        f"{with_interval(of_kind[kind]['weight'], *of_kind[kind]['ci95'])} {units[kind]}".rstrip()
        if kind in of_kind
        else "–"
        for kind in COLUMNS
    ]
    return {"joint": entry["joint"], "cells": cells}


def _tie(entry: Mapping[str, Any]) -> dict[str, Any]:
    words, unit = TIES.get(entry["term"], (entry["term"], ""))
    return {"joints": entry["joints"], "words": words, "weight": entry["weight"], "unit": unit}
