"""The kinds of left-out physics that motion alone can show, and what each must say about itself.

These effects are parameters of a forward model and not columns of a torque regression: without a measured torque there
is no residual torque to regress. So they have a catalogue and a conformance test of their own, beside that of
`lagnet.effects`; where a name stands in both, it is the same physics with the same parameters.
"""

from __future__ import annotations

from abc import ABC
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from lagnet.effects.effect import Parameter
from lagnet.servos.parameters import INDEX

LEAST_WAY = 0.02  # share of the moving samples in the direction that is taken less


@dataclass(frozen=True)
class Scales:
    """Typical sizes of one joint's motion, from which searches start.

    Args:
        torque: kp times the command error, root mean square [N m].
        speed: root mean square of the speed while it moves [rad/s].
        error: root mean square of the command error [rad].
        inertia: M_ii of the nominal model with its rotor [kg m²].
        sample: median time between samples [s].
        kp: gain of the law that is being extended [N m/rad].
    """

    torque: float
    speed: float
    error: float
    inertia: float
    sample: float
    kp: float


class ServoEffect(ABC):
    """One physical cause of an error of motion, as parameters of `lagnet.servos.parameters.LAW` that it sets free."""

    name: ClassVar[str]
    title: ClassVar[str]
    formula: ClassVar[str]
    parameters: ClassVar[tuple[Parameter, ...]]
    frees: ClassVar[tuple[tuple[str, ...], ...]]  # law parameters behind each of `parameters`; several share its value
    chosen: ClassVar[tuple[str, ...]] = ()  # law parameters that a start sets and no fit moves
    with_it: ClassVar[tuple[str, ...]] = ()  # law parameters that are fitted again with it
    contains: ClassVar[tuple[str, ...]] = ()  # special cases of it: never named beside it
    beside: ClassVar[tuple[str, ...]] = ()  # it changes one of these, without which it is nothing
    starts_alone: ClassVar[bool] = False  # True: it acts at the moments at which a joint starts from rest
    shown_by: ClassVar[str]
    confused_with: ClassVar[tuple[str, ...]] = ()
    source: ClassVar[str]

    def starts(self, scales: Scales) -> tuple[tuple[float, ...], ...]:
        """Values to start a fit from, one for each of `parameters`."""
        raise NotImplementedError

    def apply(self, law: np.ndarray, values: Mapping[str, float]) -> np.ndarray:
        """A law with the effect's values in place, shape (len(LAW),)."""
        changed = law.copy()
        for parameter, names in zip(self.parameters, self.frees, strict=True):
            for name in names:
                changed[INDEX[name]] = values[parameter.name]
        return changed

    def read(self, law: np.ndarray) -> dict[str, float]:
        """The effect's values in a law."""
        return {p.name: float(law[INDEX[n[0]]]) for p, n in zip(self.parameters, self.frees, strict=True)}

    def excitation(self, command: np.ndarray, q: np.ndarray, moving: np.ndarray) -> str | None:
        """None if a joint's recorded motion can show the effect, else why it cannot; arrays of shape (n,)."""
        if not moving.any():
            return "the joint does not move"
        return None

    def acts_beside(self, effects: Collection[str]) -> bool:
        """Whether it can act where these others do."""
        return not self.beside or any(e in effects for e in self.beside)


class ReversingEffect(ServoEffect):
    """An effect that changes its side with the direction of motion: motion in one direction alone cannot show it."""

    def excitation(self, command: np.ndarray, q: np.ndarray, moving: np.ndarray) -> str | None:
        """None if the joint moves in both directions, else why the effect cannot be shown; arrays of shape (n,)."""
        if reason := super().excitation(command, q, moving):
            return reason
        step = np.diff(q)[moving[1:]]
        if min(np.sum(step > 0.0), np.sum(step < 0.0)) < LEAST_WAY * step.size:
            return "the joint moves in one direction alone"
        return None
