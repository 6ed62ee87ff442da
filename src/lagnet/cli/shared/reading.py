"""How much of a long log has been read: one line on a terminal, nothing elsewhere."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TextIO


def while_reading(stream: TextIO | None = None) -> Callable[[str, int, int | None], None] | None:
    """What `load_recording` calls as it reads; None where nobody looks on.

    Args:
        stream: where it is shown; None: standard error.
    """
    shown = sys.stderr if stream is None else stream
    if not shown.isatty():
        return None

    def show(name: str, done: int, total: int | None) -> None:
        words = f"{done / total:4.0%} of {total:,} messages" if total else f"{done:,} messages"
        print(f"\r{name}: {words} read", end="\n" if done == total else "", file=shown, flush=True)

    return show
