"""Where the coordinates of several effects stand in one vector, and the effects that a vector stands for."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lagnet.models.corrected.named_effects import NamedEffect


@dataclass(frozen=True, eq=False)
class Slots:
    """Where each effect's coordinates stand in the vector of all.

    Args:
        effects: with the parameters that a fit starts from.
        starts: shape (n_effects + 1,), first coordinate of each, and the number of all.
    """

    effects: tuple[NamedEffect, ...]
    starts: np.ndarray

    def of(self, n: int) -> slice:
        """The coordinates of effect n."""
        return slice(int(self.starts[n]), int(self.starts[n + 1]))

    def named(self, x: np.ndarray) -> tuple[NamedEffect, ...]:
        """The effects at coordinates x, shape (k,)."""
        return tuple(e.at_coordinates(x[self.of(n)]) for n, e in enumerate(self.effects))

    def changed(self, x: np.ndarray, i: int, value: float) -> tuple[int, NamedEffect]:
        """Number of the effect that coordinate i changes, and that effect with another value of it."""
        n = int(np.searchsorted(self.starts, i, side="right")) - 1
        own = x[self.of(n)].copy()
        own[i - int(self.starts[n])] = value
        return n, self.effects[n].at_coordinates(own)

    def of_bodies(self) -> np.ndarray:
        """Whether a coordinate is one of the ten of a body, shape (k,)."""
        return np.repeat([e.is_free_body for e in self.effects], np.diff(self.starts))

    def chosen(self) -> np.ndarray:
        """Whether a coordinate stands at the value of a special case, shape (k,)."""
        return np.concatenate([np.zeros(0, dtype=bool), *(e.chosen() for e in self.effects)])

    @cached_property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper bounds, shape (k,) each."""
        pairs = [e.coordinate_bounds() for e in self.effects]
        return np.concatenate([p[0] for p in pairs]), np.concatenate([p[1] for p in pairs])
