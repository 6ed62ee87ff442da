"""Write every rule and every limit of a diagnosis from the code to docs/limits.md.

python docs/make_limits.py [--check]

What a limit does at half and at twice its value is taken from `validation/ablations/limits.json`, where that study has
measured it on plants of each kind. Columns without a figure are left out.
"""

from __future__ import annotations

import inspect
import json
import sys
from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import Any

import griffe

from lagnet.diagnosis.rules.catalogue import RULES
from lagnet.diagnosis.rules.rule import RejectionRule
from lagnet.diagnosis.settings import DecisionLimits
from marked_regions import DOCS, ROOT, replaced, write_or_check

COMMAND = "python docs/make_limits.py"
MEASURED = ROOT / "validation" / "ablations" / "limits.json"
CHANGES = {"half": "at half", "twice": "at twice"}
KINDS = {"simulated": "", "textured": "with the texture of real arms: "}
FIGURES = {
    "precision": "precision",
    "recall": "recall",
    "right_joint": "right joint",
    "interval_coverage": "coverage of intervals",
    "claims_on_plants_with_nothing_hidden": "names where nothing is hidden",
    "unlisted_given_a_wrong_name": "unlisted physics named",
}


def measured() -> dict[str, Any]:
    """Figures of the study; empty where there is none yet."""
    return json.loads(MEASURED.read_text(encoding="utf-8")) if MEASURED.exists() else {}


def meanings(kind: type) -> dict[str, str]:
    """What the Args of a class docstring say, by field."""
    text = griffe.Docstring(inspect.getdoc(kind) or "", parser="google", parser_options={"warnings": False})
    parts = [p.value for p in text.parsed if isinstance(p, griffe.DocstringSectionParameters)]
    entries = [entry for part in parts for entry in part]
    return {n.strip(): " ".join(e.description.split()) for e in entries for n in e.name.split(",")}


def numbers(settings: Any) -> Iterator[tuple[str, float]]:
    """Fields of a settings dataclass that are numbers, with their defaults."""
    for field in fields(settings):
        value = getattr(settings, field.name)
        if isinstance(value, int | float) and not isinstance(value, bool):
            yield field.name, value


def table(settings: Any, prefix: str, study: Mapping[str, Any]) -> str:
    """One row a limit.

    Raises:
        ValueError: a limit has no meaning in the docstring of its class.
    """
    said = meanings(type(settings))
    rows = list(numbers(settings))
    changes = [c for c in CHANGES if any(study.get(prefix + n, {}).get(c) for n, _ in rows)]
    out = [["limit", "default", "meaning", *(CHANGES[c] for c in changes)], ["---"] * (3 + len(changes))]
    for name, value in rows:
        if not said.get(name):
            raise ValueError(f"{type(settings).__name__}.{name} has no meaning: describe it under Args")
        figures = [change_words(study.get(prefix + name, {}).get(c)) for c in changes]
        out.append([f"`{name}`", f"{value:g}", said[name].replace("|", "\\|"), *figures])
    return "\n".join(f"| {' | '.join(row)} |" for row in out)


def change_words(change: Mapping[str, Any] | None) -> str:
    """What a changed limit does on plants of each kind."""
    if change is None:
        return "–"
    kinds = {kind: told for kind, told in change.items() if isinstance(told, Mapping)}
    return "; ".join(f"{kind}: {difference(told['whole'], told['changed'])}" for kind, told in kinds.items())


def difference(whole: Mapping[str, Any], other: Mapping[str, Any]) -> str:
    """Figures that differ from those of the default, on the same plants."""
    shown = {n: (number(whole[n]), number(other[n])) for n in FIGURES}
    changed = [f"{FIGURES[n]} {before} → {after}" for n, (before, after) in shown.items() if before != after]
    return f"{', '.join(changed) or 'no change'} ({whole['plants']} plants)"


def number(x: float | None) -> str:
    """Three digits; a dash where nothing is counted."""
    return "–" if x is None else f"{x:.3g}"


def section(rule: RejectionRule, study: Mapping[str, Any]) -> str:
    """What one rule says of itself."""
    kind = type(rule)
    path = inspect.getfile(kind).replace("\\", "/").partition("/src/")[2]
    head = " ".join((inspect.getdoc(kind) or "").split("\n\n")[0].split())
    source = f" Source: [{rule.source}](references.md#{rule.source})." if rule.source else ""
    when = "on parameters refitted by the exact laws" if rule.after_refit else "on the linear fit of the search"
    lines = [
        f"### {rule.name}",
        f"**{rule.statement[0].upper()}{rule.statement[1:]}.** {head}",
        f"Asked {when}; in [`{rule.name}.py`](../src/{path}).{source}",
    ]
    return "\n\n".join([*lines, *([table(rule, f"{rule.name}.", study)] if any(numbers(rule)) else [])])


def pages() -> dict[Any, str]:
    """The page with its regions written anew."""
    page, study = DOCS / "limits.md", measured()
    text = page.read_text(encoding="utf-8")
    text = replaced(text, "shared", table(DecisionLimits(), "", study), "docs/limits.md")
    text = replaced(text, "rules", "\n\n".join(section(r, study) for r in RULES), "docs/limits.md")
    return {page: text}


if __name__ == "__main__":
    sys.exit(write_or_check(pages(), COMMAND))
