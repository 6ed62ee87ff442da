"""Write which effect becomes what in which simulator, from the exporters and the measured round trips.

python docs/make_simulators.py [--check]
"""

from __future__ import annotations

import sys
from pathlib import Path

from lagnet.effects.catalogue import CATALOGUE
from lagnet.simulators.exporter import Exporter, Place
from lagnet.simulators.measured import engine_versions, measured_errors
from lagnet.simulators.registry import EXPORTERS
from lagnet.simulators.round_trips.reference_cases import CASES, case_values
from lagnet.simulators.servo_exporters.registry import SERVO_EXPORTERS
from lagnet.simulators.servo_exporters.servo_exporter import CAUSES, ServoExporter
from marked_regions import DOCS, replaced, write_or_check

COMMAND = "python docs/make_simulators.py"
WORDS = {"exact": "exact", "approximate": "approx.", "not_representable": "–"}


def place_of(exporter: Exporter, effect: str) -> Place:
    """The place of the reference case of an effect."""
    return exporter.place_of_values(effect, case_values(effect))


def percent(share: float) -> str:
    """A share with two digits."""
    return f"{100 * share:.2g} %"


def errors(exporter: Exporter, effect: str) -> str:
    """Measured errors, with the engine where there are several."""
    measured = measured_errors(exporter.name, effect)
    if len(measured) == 1:
        return percent(next(iter(measured.values())))
    return ", ".join(f"{engine} {percent(share)}" for engine, share in measured.items())


def cell(exporter: Exporter, effect: str) -> str:
    """Status and measured error."""
    place = place_of(exporter, effect)
    told = "" if place.status == "not_representable" else errors(exporter, effect)
    return f"{WORDS[place.status]} ({told})" if told else WORDS[place.status]


def table() -> str:
    """One row an effect, one column a simulator."""
    heads = " | ".join(e.title for e in EXPORTERS.values())
    rows = [f"| effect | {heads} |", "|---" * (1 + len(EXPORTERS)) + "|"]
    rows += [f"| `{name}` | " + " | ".join(cell(e, name) for e in EXPORTERS.values()) + " |" for name in CASES]
    versions = " and ".join(f"{name} {version}" for name, version in engine_versions().items())
    return "\n".join([*rows, "", f"Measured with {versions}; “–”: no place."])


def places() -> str:
    """One section a simulator: element and note of every effect."""
    parts = []
    for exporter in EXPORTERS.values():
        lines = [
            f"### {exporter.title}",
            "",
            f"Read by {exporter.reads}.",
            "",
            "| effect | status | element | to know |",
        ]
        lines.append("|---|---|---|---|")
        for name in CASES:
            place = place_of(exporter, name)
            cells = [f"`{name}`", WORDS[place.status], place.element or "–", place.note or "–"]
            lines.append("| " + " | ".join(c.replace("|", "\\|") for c in cells) + " |")
        parts.append("\n".join(lines))
    return "\n\n".join(parts)


def servo_table() -> str:
    """One row a cause that motion can show, one column a simulator."""
    heads = " | ".join(e.torques.title for e in SERVO_EXPORTERS.values())
    rows = [f"| cause | {heads} |", "|---" * (1 + len(SERVO_EXPORTERS)) + "|"]
    rows += [
        f"| `{name}` | " + " | ".join(servo_cell(e, name) for e in SERVO_EXPORTERS.values()) + " |" for name in CAUSES
    ]
    return "\n".join(rows)


def servo_cell(exporter: ServoExporter, cause: str) -> str:
    """Status and measured error."""
    word, measured = WORDS[exporter.places[cause].status], exporter.measured(cause)
    return f"{word} ({percent(max(measured.values()))})" if measured else word


def pages() -> dict[Path, str]:
    """The page with its regions written anew."""
    page = DOCS / "simulators.md"
    assert set(CASES) == {name for name, law in CATALOGUE.items() if not law.is_transient}
    text = replaced(page.read_text(encoding="utf-8"), "table", table(), "docs/simulators.md")
    text = replaced(text, "servo table", servo_table(), "docs/simulators.md")
    return {page: replaced(text, "places", places(), "docs/simulators.md")}


if __name__ == "__main__":
    sys.exit(write_or_check(pages(), COMMAND))
