"""Write the figures in README.md, docs and the studies' pages from result files, so that no figure is typed by hand.

python docs/fill_figures.py [--check]

A figure stands between comments that say where it comes from and how it is written:

    <!-- figure real_arms arms.ur10e.nmse_corrected.0 .2g -->0.0049<!-- /figure -->

the key path into `validation/real_arms/result.json` (numbers count through lists, `*` takes all of a list or table and
joins them with commas, `max`, `min`, `median`, `len` after it reduces them), then a Python format. Another result file
of a study is told as `ablations/consulted` in the place of its name.
"""

from __future__ import annotations

import json
import re
import statistics
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from marked_regions import DOCS, ROOT, write_or_check

COMMAND = "python docs/fill_figures.py"
FIGURE = re.compile(r"<!-- figure ([\w/]+) (\S+) (\S+) -->.*?<!-- /figure -->", re.DOTALL)
REDUCE: dict[str, Callable[[list[Any]], Any]] = {
    "max": max,
    "min": min,
    "median": statistics.median,
    "len": len,
}


def lookup(value: Any, path: list[str]) -> Any:
    """What stands at a key path.

    Raises:
        KeyError, IndexError: there is no such place.
    """
    if not path:
        return value
    key, rest = path[0], path[1:]
    if key == "*":
        every = [lookup(v, [p for p in rest if p not in REDUCE]) for v in _items(value)]
        return REDUCE[rest[-1]](every) if rest and rest[-1] in REDUCE else every
    return lookup(value[int(key)] if isinstance(value, list) else value[key], rest)


def _items(value: Any) -> list[Any]:
    return list(value.values()) if isinstance(value, dict) else list(value)


def written(value: Any, form: str) -> str:
    """A number in its format, several joined by commas, a truth as yes or no."""
    if isinstance(value, list):
        return ", ".join(written(v, form) for v in value)
    if isinstance(value, bool):
        return "yes" if value else "no"
    return format(value, "" if form == "text" else form)


def filled(text: str, where: str) -> str:
    """The text with every figure as the result files have it.

    Raises:
        ValueError: a figure names a file or place that is not there.
    """

    def fill(found: re.Match[str]) -> str:
        study, path, form = found[1], found[2], found[3]
        file = ROOT / "validation" / f"{study if '/' in study else f'{study}/result'}.json"
        try:
            value = lookup(json.loads(file.read_text(encoding="utf-8")), path.split("."))
        except (OSError, KeyError, IndexError, TypeError) as error:
            raise ValueError(f"{where}: no {path} in {file.relative_to(ROOT)} ({error})") from None
        return f"<!-- figure {study} {path} {form} -->{written(value, form)}<!-- /figure -->"

    return FIGURE.sub(fill, text)


def pages() -> dict[Path, str]:
    """Every Markdown file of README, docs and the studies, filled."""
    files = [ROOT / "README.md", *sorted(DOCS.glob("*.md")), *sorted((ROOT / "validation").glob("*/README.md"))]
    return {f: filled(f.read_text(encoding="utf-8"), str(f.relative_to(ROOT))) for f in files}


if __name__ == "__main__":
    sys.exit(write_or_check(pages(), COMMAND))
