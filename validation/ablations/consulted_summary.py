"""What consulted cases say of a rule: how often it rejects, by kind of data, and which names are others without it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

from lagnet.diagnosis.rules.catalogue import RULES

Kept = Sequence[dict[str, Any]]


def summary(kept: Kept) -> dict[str, dict[str, dict[str, int]]]:
    """By rule and kind of data: cases with a rejection at any point, and with one in the verdict."""
    kinds = list(dict.fromkeys(case["kind"] for case in kept))
    return {
        rule.name: {kind: _counts(rule.name, [c for c in kept if c["kind"] == kind]) for kind in kinds}
        for rule in RULES
    }


def _counts(rule: str, cases: Kept) -> dict[str, int]:
    asked = [c for c in cases if rule in c["without"]]
    return {
        "cases": len(cases),
        **{when: sum(any(p.startswith(f"{rule}:") for p in c[when]) for c in cases) for when in WHEN},
        "asked_without": len(asked),
        "other_names_without": sum({*c["without"][rule]["names"]} != {*c["names"]} for c in asked),
    }


WHEN = ("at_any_point", "in_the_verdict")


def differences(kept: Kept) -> dict[str, dict[str, Any]]:
    """Cases whose names are others without a rule, with what is hidden and the ratio of held-out errors by joint."""
    return {
        f"{rule}__{case['kind']}__{slug(case['name'])}": {"hidden": case["hidden"], **_difference(case, other)}
        for case in kept
        for rule, other in case["without"].items()
        if {*other["names"]} != {*case["names"]}
    }


def slug(name: str) -> str:
    """A name as a key or a file's name."""
    return re.sub("[^a-z0-9]+", "_", name)


def _difference(case: dict[str, Any], other: dict[str, Any]) -> dict[str, Any]:
    """Names that one of two verdicts gives alone, those of both being left out; effects that only change ties count."""
    pairs = zip(other["nmse_named"], case["nmse_named"], strict=True)
    return {
        "named_without_it": _told_alone(other["names"], case["names"], case["hidden"]),
        "named_with_it": _told_alone(case["names"], other["names"], case["hidden"]),
        "error_without_over_with": [round(a / b, 4) for a, b in pairs],
    }


def _told_alone(names: dict[str, Any], others: dict[str, Any], hidden: list[str] | None) -> list[dict[str, Any]]:
    return [
        {"name": name, "is_hidden": None if hidden is None else is_hidden(name, hidden), "parameters": values}
        for name, values in names.items()
        if name not in others
    ]


def is_hidden(name: str, hidden: Sequence[str]) -> bool:
    """Whether a name, or a tie with it, is one of the hidden causes at its joint."""
    (first, *ties), place = [part.strip() for part in name.split("|")], name.partition(" @ ")[2].split(" |")[0]
    effects = {first.partition(" @ ")[0], *(tie.partition(" @ ")[0] for tie in ties)}
    return any(cause.partition(" @ ")[0] in effects and cause.partition(" @ ")[2] == place for cause in hidden)


def table(rules: dict[str, dict[str, dict[str, int]]]) -> str:
    """A row a rule, a column a kind: cases with a rejection; in brackets, those whose names differ without the rule."""
    kinds = list(next(iter(rules.values())))
    head = [f"{kind.replace('_', ' ')} ({next(iter(rules.values()))[kind]['cases']})" for kind in kinds]
    rows = [[f"`{rule}`", *(_cell(of[kind]) for kind in kinds)] for rule, of in rules.items()]
    lines = [["rule", *head], ["---"] * (1 + len(kinds)), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _cell(counts: dict[str, int]) -> str:
    asked = f" ({counts['other_names_without']} of {counts['asked_without']})" if counts["asked_without"] else ""
    return f"{counts['at_any_point']}{asked}" if counts["at_any_point"] else "–"
