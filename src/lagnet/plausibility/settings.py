"""What a user may ask of the suite."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class CheckSettings:
    """How hard the suite looks, and where its limits differ from the suite's own.

    Args:
        limits: limit by name of check, in the check's unit.
        skip: names of checks that are left out.
        vertical_base: the first axis is vertical, so that its angle must not matter; the check of it is made only then.
        samples: random configurations that each check looks at before it searches.
        starts: worst samples from which a local search for a violation begins.
        iterations: steps of each local search.
    """

    limits: Mapping[str, float] = field(default_factory=dict)
    skip: tuple[str, ...] = ()
    vertical_base: bool = False
    samples: int = 192
    starts: int = 3
    iterations: int = 10
