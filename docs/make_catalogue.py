"""Write what is known of every effect from the code to docs/catalogue.md and to the table in README.md.

python docs/make_catalogue.py [--check]
"""

from __future__ import annotations

import sys
from pathlib import Path

from lagnet.effects.catalogue import CATALOGUE
from lagnet.effects.effect import Effect, Parameter
from marked_regions import DOCS, ROOT, replaced, write_or_check

COMMAND = "python docs/make_catalogue.py"
PLACES = {"body": "on bodies", "transmission": "at a joint", "torque": "at a joint", "signal": "in the recorded signal"}


def cell(text: str) -> str:
    """Words that do not break a table."""
    return text.replace("|", "\\|")


def parameter(p: Parameter) -> str:
    """Name and unit."""
    return f"`{p.name}` [{p.unit}]"


def parameters(effect: Effect) -> str:
    """All parameters; those of one unit and a common head together."""
    groups: dict[str, list[str]] = {}
    for p in effect.parameters:
        groups.setdefault(p.unit, []).append(p.name)
    return "; ".join(f"{', '.join(f'`{n}`' for n in names)} [{unit}]" for unit, names in groups.items())


def where(effect: Effect) -> str:
    """Where it acts."""
    return "the whole arm" if effect.whole_arm else PLACES[effect.stage]


def readme_table() -> str:
    """One short row an effect."""
    rows = ["| effect | added torque | what is found |", "|---|---|---|"]
    rows += [f"| `{e.name}` | {cell(e.formula)} | {cell(parameters(e))} |" for e in CATALOGUE.values()]
    return "\n".join(rows)


def overview() -> str:
    """One row an effect with all that it says about itself."""
    rows = ["| name | added torque | parameters | shown by | hard to tell from | source |", "|---|---|---|---|---|---|"]
    for e in CATALOGUE.values():
        rivals = ", ".join(f"`{n}`" for n in e.confused_with) or "–"
        name = f"[`{e.name}`](#{e.name})"
        source = f"[{e.source}](references.md#{e.source})"
        rows.append(
            f"| {name} | {cell(e.formula)} | {cell(parameters(e))} | {cell(e.shown_by)} | {rivals} | {source} |"
        )
    return "\n".join(rows)


def bounds(p: Parameter) -> str:
    """Range that physics allows."""
    low, high = (f"{x:g}".replace("inf", "∞").replace("-", "−") for x in (p.lower, p.upper))
    return f"{low} … {high}"


def entry(effect: Effect) -> str:
    """The section of one effect."""
    said = " ".join((type(effect).__doc__ or "").split("\n\n")[0].split())
    traits = [f"acts {where(effect)}" if not effect.whole_arm else "acts on the whole arm"]
    traits += ["changes the torque of other joints too"] if effect.reaches_all else []
    traits += ["needs a nominal model with bodies (URDF, MJCF)"] if effect.needs_bodies else []
    traits += ["depends on what came before"] if not effect.instantaneous else []
    if effect.contains:
        traits.append("contains " + ", ".join(f"`{n}`" for n in effect.contains) + ", never named beside it")
    rows = "\n".join(
        f"| `{p.name}` | {cell(p.symbol)} | {p.unit} | {cell(p.meaning)} | {bounds(p)} |" for p in effect.parameters
    )
    return (
        f"### {effect.name}\n\n{effect.title}. {said}\n\n"
        f"It {', '.join(traits)}.\n\n| parameter | symbol | unit | meaning | range |\n|---|---|---|---|---|\n{rows}"
    )


def pages() -> dict[Path, str]:
    """The two files with their regions written anew."""
    catalogue, readme = DOCS / "catalogue.md", ROOT / "README.md"
    text = catalogue.read_text(encoding="utf-8")
    text = replaced(text, "overview", overview(), "docs/catalogue.md")
    text = replaced(text, "effects", "\n\n".join(map(entry, CATALOGUE.values())), "docs/catalogue.md")
    table = replaced(readme.read_text(encoding="utf-8"), "effects", readme_table(), "README.md")
    return {catalogue: text, readme: table}


if __name__ == "__main__":
    sys.exit(write_or_check(pages(), COMMAND))
