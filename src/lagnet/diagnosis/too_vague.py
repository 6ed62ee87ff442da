"""A cause that could be any of many is no name: it is told as an abstention, and stays in what is unexplained."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from lagnet.diagnosis.arm_search import Found
from lagnet.diagnosis.fitting import Workbench
from lagnet.diagnosis.library import Library
from lagnet.diagnosis.rivals import Contest
from lagnet.diagnosis.settle import without

MOST_NAMES = 4  # that a claim may stand for, its own among them


@dataclass(frozen=True)
class TooVague:
    """A cause that the recordings narrow down to no fewer than these.

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


def too_vague(library: Library, contests: Sequence[Contest]) -> dict[int, TooVague]:
    """The selected hypotheses that are tied with too many others, by their index."""
    named = ((c, library.hypotheses[c.index]) for c in contests if len(c.tied) >= MOST_NAMES)
    return {c.index: TooVague(h.effect, h.joint, c.tied) for c, h in named}


def all_without(bench: Workbench, found: Found, indices: Sequence[int]) -> Found:
    """The selection less some hypotheses, refitted."""
    for index in indices:
        found = without(bench, found, index)
    return found
