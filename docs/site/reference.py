"""A hook of MkDocs: the reference, one page a room of the package, made of the docstrings."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File

import lagnet

SOURCE = Path(__file__).resolve().parents[2] / "src"
PACKAGE = SOURCE / "lagnet"
HEAD = "reference/lagnet.md"


def on_config(config: Any) -> Any:
    """Name the pages of the reference in the navigation."""
    config.nav.append({"Reference": [HEAD, *({_title(r): _page(r)} for r in rooms())]})
    return config


def on_files(files: Any, config: Any) -> Any:
    """Add the pages of the reference."""
    files.append(File.generated(config, HEAD, content=_public()))
    for room in rooms():
        files.append(File.generated(config, _page(room), content=_reference(room)))
    return files


def rooms() -> list[Path]:
    """Folders of the package with modules of their own, by name; the package itself goes first."""
    folders = [f for f in sorted(PACKAGE.rglob("*")) if (f / "__init__.py").is_file()]
    return [PACKAGE, *(f for f in folders if _modules(f) or _words(f))]


def _modules(room: Path) -> list[str]:
    return [_name(f) for f in sorted(room.glob("*.py")) if not f.name.startswith("_")]


def _name(path: Path) -> str:
    return ".".join(path.relative_to(SOURCE).with_suffix("").parts)


def _title(room: Path) -> str:
    return _name(room).removeprefix("lagnet.") if room != PACKAGE else "types, errors"


def _page(room: Path) -> str:
    return f"reference/{_name(room).removeprefix('lagnet.')}.md" if room != PACKAGE else "reference/ground.md"


def _words(room: Path) -> str:
    return (importlib.import_module(_name(room)).__doc__ or "").strip()


def _reference(room: Path) -> str:
    own = f"::: {_name(room)}\n    options:\n      heading_level: 1\n      members: false\n"
    return "\n\n".join([own if room != PACKAGE else f"# {_title(room)}", *(f"::: {m}" for m in _modules(room))])


def _public() -> str:
    """What `import lagnet` offers, each with the first line of its docstring."""
    rows = ["# lagnet", "What `import lagnet` offers. All else is reached through the rooms.", ""]
    for name in sorted(n for n in lagnet.__all__ if not n.startswith("_")):
        value = getattr(lagnet, name)
        place = lagnet._PUBLIC[name].replace(":", ".")
        words = (getattr(value, "__doc__", "") or "").strip().split("\n\n")[0] if callable(value) else ""
        rows.append(f"- [`lagnet.{name}`][{place}]: {' '.join(words.split())}".removesuffix(": "))
    return "\n".join([*rows[:2], "", *rows[2:]])
