"""Ambiguous causes: tied with so many names that none is reported; they become abstentions and stay unexplained."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from lagnet.diagnosis.identifiability.rivals import Comparison
from lagnet.diagnosis.regression.library import Library


@dataclass(frozen=True)
class AmbiguousCause:
    """A cause for which the recordings leave at least these names.

    Args:
        effect, joint: the likeliest.
        tied: the names that they cannot tell from it.
    """

    effect: str
    joint: int | None
    tied: tuple[str, ...]

    @property
    def reason(self) -> str:
        """In words."""
        return f"something is there, but the recordings do not tell it from {', '.join(self.tied)}"


def ambiguous_causes(library: Library, comparisons: Sequence[Comparison], most_names: int) -> dict[int, AmbiguousCause]:
    """The selected hypotheses that are tied with too many others, by their index."""
    named = ((c, library.hypotheses[c.index]) for c in comparisons if len(c.tied) >= most_names)
    return {c.index: AmbiguousCause(h.effect, h.joint, c.tied) for c, h in named}
