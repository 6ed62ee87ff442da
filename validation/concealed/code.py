"""Which lagnet is being judged: where it lies, and the sha256 of its source, kept with every plant."""

from __future__ import annotations

import hashlib
from pathlib import Path

import lagnet

PACKAGE = Path(lagnet.__file__).resolve().parent


def fingerprint() -> str:
    """sha256 over names and contents of all source files of the package."""
    digest = hashlib.sha256()
    for file in sorted(PACKAGE.rglob("*.py")):
        digest.update(str(file.relative_to(PACKAGE)).encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()
