"""How far the members of an ensemble differ: what the data left open shows as a band."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lagnet.decomposition.terms import TERMS, Terms
from lagnet.types import Trajectory


@dataclass(frozen=True, eq=False)
class Spread:
    """Standard deviation over members, of each term and of the total.

    Args:
        members: how many models.
        of: by name of term, shape (n, dof) [N m].
    """

    members: int
    of: dict[str, Trajectory]


def spread_of(split: Sequence[Terms]) -> tuple[Terms, Spread | None]:
    """The mean of the members' terms, and their spread; no spread for a single model."""
    if len(split) == 1:
        return split[0], None
    mean = Terms(*(np.mean([getattr(member, name) for member in split], axis=0) for name in TERMS))
    parts = [dict(member.items()) for member in split]
    return mean, Spread(len(split), {name: np.std([p[name] for p in parts], axis=0, ddof=1) for name in parts[0]})
