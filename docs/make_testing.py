"""Write how long tests take, before and after a change, to docs/testing.md.

python docs/make_testing.py BEFORE.txt AFTER.txt

Each file is what `make test PYTEST_ARGS="--durations=0"` printed.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

from marked_regions import DOCS, replaced

LONGEST = 20
LINE = re.compile(r"^([\d.]+)s (call|setup|teardown) +(\S+)")
TOTAL = re.compile(r"(\d+) passed.* in ([\d.]+)s")


def durations(text: str) -> dict[str, float]:
    """Seconds of each test by its name, set-up and tear-down included."""
    out: dict[str, float] = {}
    for found in filter(None, map(LINE.match, text.splitlines())):
        out[found[3]] = out.get(found[3], 0.0) + float(found[1])
    return out


def table(before: str, after: str) -> str:
    """The slowest tests before, with their time now."""
    was, now = durations(before), durations(after)
    rows = [f"| `{name.removeprefix('tests/')}` | {was[name]:.1f} | {_told(now, name)} |" for name in _slowest(was)]
    totals = [TOTAL.search(text) for text in (before, after)]
    words = [f"{found[1]} tests in {float(found[2]):.0f} s" if found else "not told" for found in totals]
    head = f"Before: {words[0]}; now: {words[1]} (two workers).\n\n| test | before [s] | now [s] |\n|---|---|---|\n"
    return head + "\n".join(rows)


def _slowest(times: dict[str, float]) -> list[str]:
    return sorted(times, key=lambda name: -times[name])[:LONGEST]


def _told(now: dict[str, float], name: str) -> str:
    return f"{now[name]:.1f}" if name in now else "with the slow tests, or below the least that was printed"


def main() -> None:
    """Write the table between its marks."""
    before, after = (Path(p).read_text(encoding="utf-8") for p in sys.argv[1:3])
    page = DOCS / "testing.md"
    page.write_text(
        replaced(page.read_text(encoding="utf-8"), "durations", table(before, after), page.name), encoding="utf-8"
    )


if __name__ == "__main__":
    main()
