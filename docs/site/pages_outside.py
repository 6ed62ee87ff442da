"""A hook of MkDocs: pages outside docs/ that are linked to join the site; links to code lead to its reference.

The Markdown of this repository links from file to file, so that it can be read where it lies. The site has the same
links: CONTRIBUTING, studies and what these link to become pages of it, `src/lagnet/a/b.py` becomes the entry of
`lagnet.a.b`.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
CODE = r"^```.*?^```|`[^`\n]*`"
TARGET = re.compile(rf"(?P<code>{CODE})|(?P<text>!?\[[^\]]*\])\((?P<target>[^)\s]+)\)", re.DOTALL | re.MULTILINE)
RENAMED = {"README.md": "overview.md"}  # a README beside index.md would take its place


def on_config(config: Any) -> Any:
    """Order the pages as docs/index.md does."""
    config.nav = ["index.md", *_parts()]
    return config


def on_files(files: Any, config: Any) -> Any:
    """Add what lies outside docs/ and is linked to, directly or from a page so added; the reference stays last."""
    left = [Path(f.abs_src_path) for f in files.documentation_pages() if f.abs_src_path]
    seen = set(left)
    while left:
        for there, _ in _linked(left.pop()):
            if there in seen or there.is_relative_to(DOCS) or _module(there):
                continue
            seen.add(there)
            files.append(File.generated(config, site_name(there), abs_src_path=str(there)))
            left += [there] if there.suffix == ".md" else []
    named = {page for part in _parts() for pages in part.values() for page in pages}
    others = {site_name(p) for p in seen if p.suffix == ".md" and not p.is_relative_to(DOCS)} - named
    config.nav[-1:-1] = [{"Studies": sorted(others)}]
    return files


def on_page_markdown(markdown: str, page: Any, config: Any, files: Any) -> str:
    """Links as they are in the site."""
    if not page.file.abs_src_path:
        return markdown
    here = Path(page.file.abs_src_path)

    def moved(found: re.Match[str]) -> str:
        there, anchor = _there(here, found["target"] or "")
        if there is None:
            return found[0]
        if module := _module(there):
            return f"{found['text']}[{module}]"
        path = posixpath.relpath(site_name(there), posixpath.dirname(page.file.src_uri))
        return f"{found['text']}({path}{anchor})"

    return TARGET.sub(moved, markdown)


def site_name(there: Path) -> str:
    """Path in the site's sources of a file of the repository."""
    if there.is_relative_to(DOCS):
        return there.relative_to(DOCS).as_posix()
    name = there.relative_to(ROOT).as_posix()
    return RENAMED.get(name, name)


def _parts() -> list[dict[str, list[str]]]:
    """The lists of docs/index.md: title and pages of each, the first link of every item."""
    index = DOCS / "index.md"
    parts = re.findall(r"^(.+):\n\n((?:[- ] .*\n)+)", index.read_text(encoding="utf-8"), re.MULTILINE)
    items = {title: re.findall(r"^- \[[^\]]*\]\(([^)]+)\)", text, re.MULTILINE) for title, text in parts}
    return [{title: [site_name((DOCS / link).resolve()) for link in links]} for title, links in items.items()]


def _linked(page: Path) -> Iterator[tuple[Path, str]]:
    for found in TARGET.finditer(page.read_text(encoding="utf-8")):
        there, anchor = _there(page, found["target"] or "")
        if there is not None:
            yield there, anchor


def _there(page: Path, target: str) -> tuple[Path | None, str]:
    """The file of this repository that a link leads to, and its anchor; None: it leads elsewhere or to no file."""
    path, mark, anchor = target.partition("#")
    there = (page.parent / path).resolve()
    if not path or re.match(r"[a-z]+:", target) or not there.is_file() or not there.is_relative_to(ROOT):
        return None, ""
    return there, mark + anchor


def _module(there: Path) -> str:
    """Dotted name of a module of the package; "" for any other file."""
    source = ROOT / "src"
    if there.suffix != ".py" or not there.is_relative_to(source):
        return ""
    return ".".join(there.relative_to(source).with_suffix("").parts).removesuffix(".__init__")
