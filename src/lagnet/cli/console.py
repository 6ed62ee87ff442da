"""What commands print: plain lines."""

from __future__ import annotations

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
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise LagnetError(
            f"{text!r} is not a list of numbers", where=option, next_step="separate them by commas, like 14.87,13.26"
        ) from None
