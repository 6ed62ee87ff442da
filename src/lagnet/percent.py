"""Shares in sentences; pages of a report write theirs in their own typography."""

from __future__ import annotations

LEAST = 0.01  # per cent that is written as a number


def percent(share: float, digits: int = 2) -> str:
    """A share as a percentage with so many significant digits and no power of ten: 250 %, 46 %, 0.034 %."""
    value = 100.0 * share
    if 0.0 <= value < LEAST:
        return f"less than {LEAST:g} %"
    return f"{value:.0f} %" if abs(value) >= 10.0 ** (digits - 1) else f"{value:.{digits}g} %"
