"""Folders of finished work: each appears whole or not at all, and says from which inputs it was made."""

from __future__ import annotations

import hashlib
import json
import shutil
import uuid
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

FILE = "tracked.json"
PART = ".part"


def fingerprint(*inputs: Any) -> str:
    """Checksum of everything that a result depends on, given as plain values."""
    return hashlib.sha256(json.dumps(inputs, sort_keys=True, default=str).encode()).hexdigest()


def read_finished(folder: Path, expected: str) -> dict[str, Any] | None:
    """What was written to a finished folder; None where there is none, or it was made from other inputs."""
    try:
        told = json.loads((folder / FILE).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return told if isinstance(told, dict) and told.get("fingerprint") == expected else None


def write_finished(
    folder: Path, made_from: str, told: Mapping[str, Any], fill: Callable[[Path], None]
) -> dict[str, Any]:
    """Fills a folder beside the final one and renames it at the end.

    Args:
        folder: the final one; what an older run left there is replaced.
        made_from: fingerprint of the inputs.
        told: plain values that later steps read.
        fill: writes everything else into the folder that it is given.
    """
    folder.parent.mkdir(parents=True, exist_ok=True)
    part = folder.with_name(f".{folder.name}.{uuid.uuid4().hex}{PART}")
    part.mkdir()
    content = {"fingerprint": made_from, **told}
    try:
        fill(part)
        (part / FILE).write_text(json.dumps(content, indent=1, allow_nan=False) + "\n", encoding="utf-8")
        if folder.exists():
            old = folder.with_name(f".{folder.name}.{uuid.uuid4().hex}{PART}")
            folder.rename(old)
            shutil.rmtree(old, ignore_errors=True)
        part.rename(folder)
    finally:
        shutil.rmtree(part, ignore_errors=True)
    return content


def remove_parts(root: Path) -> None:
    """Removes what killed runs left half-written."""
    for part in root.rglob(f".*{PART}"):
        shutil.rmtree(part, ignore_errors=True)
