"""What commands print: plain lines."""

from __future__ import annotations


def say(text: str) -> None:
    """One line for the person at the terminal."""
    print(text, flush=True)
