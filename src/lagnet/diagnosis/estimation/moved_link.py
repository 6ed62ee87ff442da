"""τ(q + x, v + ẋ, a + ẍ) − τ(q, v, a) of one transmission, and what small changes of x and of the bodies change of it.

To first order that is ∂τ/∂(q, v, a)_j δ(x, ẋ, ẍ) + (Y(q + x, …) − Y(q, …)) δπ. Slopes and columns at the moved link are
computed once and serve for every coordinate of a refit, where each would ask for Newton–Euler passes of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from lagnet.effects.catalogue import effect_named
from lagnet.effects.motion import Motion
from lagnet.effects.slopes import ANGLE
from lagnet.effects.transmission import Shift, Transmission
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.models.corrected.presence import presence
from lagnet.models.corrected.shifted_bodies import differing_torque
from lagnet.models.corrected.shifted_weights import body_columns, moved, moved_bodies
from lagnet.models.corrected.tilted_bodies import TILT, change_of_gravity, link_of

SIGNALS = "qva"


class MovedLink:
    """One transmission among other effects, at the values that these have."""

    def __init__(self, motion: Motion, effect: NamedEffect, effects: Sequence[NamedEffect]):
        """Places the link.

        Args:
            motion: under the load that transmissions feel.
            effect: the transmission.
            effects: all that act.
        """
        self._motion, self._effect, self._effects = motion, effect, effects
        self._joint = 0 if effect.joint is None else effect.joint
        self._share = np.asarray(presence(motion, effect))[..., None]
        self._shift = self._shift_of(motion, effect)
        self._there = moved(motion, self._joint, dict(zip(SIGNALS, self._shift, strict=True)))
        self._known: dict[int, np.ndarray] = {}

    def if_other(self, effect: NamedEffect) -> np.ndarray:
        """What other parameters of the transmission change, shape (n, dof) [N m]; exact."""
        shift = dict(zip(SIGNALS, self._shift_of(self._motion, effect), strict=True))
        return self._share * (self._torque(moved(self._motion, self._joint, shift)) - self._torque_there)

    def if_loaded(self, felt: Motion) -> np.ndarray | float:
        """What another load changes, shape (n, dof) [N m]; 0 where the link does not feel it."""
        shift = self._shift_of(felt, self._effect)
        further = [s - t for s, t in zip(shift, self._shift, strict=True)]
        if not any(d.any() for d in further):
            return 0.0
        return self._share * sum(d[:, None] * slope for d, slope in zip(further, self._slopes, strict=True))

    def if_changed(self, body: NamedEffect, other: NamedEffect) -> np.ndarray | float:
        """What other parameters of a payload or link change, shape (n, dof) [N m]; 0 if it stays still."""
        if not moved_bodies(self._joint, [body]):
            return 0.0
        law, share = effect_named(body.effect), np.asarray(presence(self._motion, body))[..., None]
        change = law.body_parameters(other.values) - law.body_parameters(body.values)
        return (self._columns_of(link_of(self._motion, body)) @ change) * share * self._share

    def _shift_of(self, motion: Motion, effect: NamedEffect) -> Shift:
        law = effect_named(effect.effect)
        assert isinstance(law, Transmission)
        return law.shift(motion, self._joint, effect.values)

    @cached_property
    def _slopes(self) -> tuple[np.ndarray, ...]:
        """∂τ/∂q_j, ∂τ/∂v_j and ∂τ/∂a_j of all bodies at the moved link, exact in speed and acceleration."""
        steps = {"q": ANGLE, "v": 1.0, "a": 1.0}
        return tuple(self._central(signal, step) for signal, step in steps.items())

    def _central(self, signal: str, step: float) -> np.ndarray:
        unit = np.full_like(self._motion.time, step)
        more, less = (self._torque(moved(self._there, self._joint, {signal: u})) for u in (unit, -unit))
        return (more - less) / (2.0 * step)

    @cached_property
    def _torque_there(self) -> np.ndarray:
        return self._torque(self._there)

    def _torque(self, motion: Motion) -> np.ndarray:
        nominal = motion.model.inverse_dynamics(motion.q, motion.v, motion.a)
        return nominal + differing_torque(motion, self._joint, self._effects)

    def _columns_of(self, link: int) -> np.ndarray:
        """Y(q + x, …) − Y(q, …) of one link in the turned field, shape (n, dof, 10); kept for the last link alone."""
        if link not in self._known:
            self._known.clear()
            self._known[link] = self._columns(link)
        return self._known[link]

    def _columns(self, link: int) -> np.ndarray:
        here, there = self._motion, self._there
        before = here.remembered(("columns of a body", link), lambda: body_columns(here, link))
        columns = body_columns(there, link) - before
        change = change_of_gravity(here, [e for e in self._effects if e.effect == TILT])
        if not change.any():
            return columns
        further = here.bodies.weight_regressor(link, there.q) - here.bodies.weight_regressor(link, here.q)
        return columns + np.tensordot(change, further, 1)
