"""Parts of a Markdown file that scripts write, between a pair of comments: `<!-- name -->` and `<!-- /name -->`."""

from __future__ import annotations

import re
import sys
from pathlib import Path

DOCS = Path(__file__).resolve().parent
ROOT = DOCS.parent


def replaced(text: str, name: str, new: str, where: str) -> str:
    """The text with another content between the comments of that name.

    Raises:
        ValueError: the text has no such pair, or several.
    """
    pattern = re.compile(rf"(<!-- {re.escape(name)} -->).*?(<!-- /{re.escape(name)} -->)", re.DOTALL)
    found = pattern.findall(text)
    if len(found) != 1:
        raise ValueError(f"{where}: {len(found)} regions called {name!r}, one is needed")
    return pattern.sub(lambda pair: f"{pair[1]}\n{new.strip()}\n{pair[2]}", text)


def write_or_check(pages: dict[Path, str], command: str) -> int:
    """Write the pages; with --check on the command line only say which are out of date, and return 1 if any is."""
    stale = [p for p, text in pages.items() if not p.exists() or p.read_text(encoding="utf-8") != text]
    if "--check" in sys.argv[1:]:
        for page in stale:
            print(f"{page.relative_to(ROOT)} is out of date: run {command}")
        return 1 if stale else 0
    for page in stale:
        page.write_text(pages[page], encoding="utf-8")
        print(f"wrote {page.relative_to(ROOT)}")
    return 0
