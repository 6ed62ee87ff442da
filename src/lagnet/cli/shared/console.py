"""What commands print: plain lines."""

from __future__ import annotations

import math

from lagnet.errors import LagnetError


def say(text: str) -> None:
    """One line for the person at the terminal."""
    print(text, flush=True)


def numbers(text: str, option: str) -> list[float]:
    """Comma-separated numbers of an option.

    Raises:
        LagnetError: a part is no number.
    """
    try:
        found = [float(part) for part in text.split(",")]
    except ValueError:
        found = [math.nan]
    if not all(map(math.isfinite, found)):
        raise LagnetError(
            f"{text!r} is not a list of numbers", where=option, next_step="separate them by commas, like 14.87,13.26"
        )
    return found


def above_zero(value: float | None, option: str) -> None:
    """Refuses what is not a finite number above zero; None was not given.

    Raises:
        LagnetError: names the option and its range.
    """
    if value is not None and not (math.isfinite(value) and value > 0):
        raise LagnetError(f"must be a number above 0, not {value:g}", where=option)


def not_negative(value: float | None, option: str) -> None:
    """Refuses what is not a finite number of at least zero; None was not given.

    Raises:
        LagnetError: names the option and its range.
    """
    if value is not None and not (math.isfinite(value) and value >= 0):
        raise LagnetError(f"must be a number of at least 0, not {value:g}", where=option)
