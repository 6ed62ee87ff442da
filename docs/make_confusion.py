"""Write what was named as what, effect × effect, from the result of the concealed study to docs/concealed_proof.md.

python docs/make_confusion.py [--check]
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable
from pathlib import Path

from marked_regions import DOCS, ROOT, replaced, write_or_check

COMMAND = "python docs/make_confusion.py"
RESULT = ROOT / "validation" / "concealed" / "result.json"
PAGE = DOCS / "concealed_proof.md"
NOTHING, UNLISTED = "nothing", "unlisted:"

Counts = dict[str, dict[str, int]]
"""Hidden cause → name that was given on its joint → how often."""


def in_order(names: Iterable[str]) -> list[str]:
    """Effects of the catalogue first, then physics in no catalogue, then nothing."""
    return sorted(names, key=lambda n: (n == NOTHING, n.startswith(UNLISTED), n))


def columns_of(confusion: Counts) -> list[str]:
    """Every name that was hidden or given, in the order of the rows, so that right answers lie on the diagonal."""
    named = {name for row in confusion.values() for name in row}
    return in_order(named | {r for r in confusion if not r.startswith(UNLISTED)})


def table(confusion: Counts) -> str:
    """A row a cause, a numbered column a name; an empty cell is never, and a right answer is bold."""
    columns = columns_of(confusion)
    numbers = {name: n + 1 for n, name in enumerate(columns)}
    heads = [str(numbers[c]) if c != NOTHING else NOTHING for c in columns]
    lines = [f"| hidden | {' | '.join(heads)} |", f"|---|{'---:|' * len(columns)}"]
    for row in in_order(confusion):
        cells = [_cell(row, column, confusion[row].get(column, 0)) for column in columns]
        lines.append(f"| {_title(row, numbers)} | {' | '.join(cells)} |")
    return "\n".join(lines)


def _cell(row: str, column: str, count: int) -> str:
    if not count:
        return ""
    right = row == column or (row.startswith(UNLISTED) and column == NOTHING)
    return f"**{count}**" if right else str(count)


def _title(row: str, numbers: dict[str, int]) -> str:
    name = row.removeprefix(UNLISTED).replace("_", " ")
    if row.startswith(UNLISTED):
        return f"unlisted: {name}"
    return NOTHING if row == NOTHING else f"{numbers[row]} `{row}`"


def pages() -> dict[Path, str]:
    """The page with the table as the result file has it."""
    confusion = json.loads(RESULT.read_text(encoding="utf-8"))["confusion"]
    return {PAGE: replaced(PAGE.read_text(encoding="utf-8"), "confusion", table(confusion), PAGE.name)}


if __name__ == "__main__":
    sys.exit(write_or_check(pages(), COMMAND))
