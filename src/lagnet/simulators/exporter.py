"""What every exporter answers: for each named effect, what element it becomes and how exactly, and the files."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar, Literal

from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.simulators.corrected_arm.arm_physics import ArmPhysics
from lagnet.simulators.measured import measured_errors

Status = Literal["exact", "approximate", "not_representable"]


@dataclass(frozen=True)
class Place:
    """Where an effect goes in a simulator.

    Args:
        status: 'exact': the element states the same law; 'approximate': a law near it; 'not_representable': none.
        element: the element, attribute or call; "" where there is none.
        note: what to know about it, or the reason why there is none.
    """

    status: Status
    element: str
    note: str = ""


def exact(element: str, note: str = "") -> Place:
    """The element states the same law."""
    return Place("exact", element, note)


def approximate(element: str, note: str) -> Place:
    """The element states a law near it."""
    return Place("approximate", element, note)


def nowhere(reason: str) -> Place:
    """The simulator has no place for it."""
    return Place("not_representable", "", reason)


PASSING = nowhere("it belongs to an interval of a recording, not to the arm")
LEARNED = nowhere("a learned remainder is no physics that a simulator has an element for")


class Exporter(ABC):
    """One simulator or format.

    A final class declares its name, a place for every effect of the catalogue that lasts, and how it is written.
    """

    name: ClassVar[str]
    title: ClassVar[str]
    reads: ClassVar[str]  # what reads the files, and from which version on
    places: ClassVar[Mapping[str, Place]]
    engine: ClassVar[str | None] = None  # name of the engine in which lagnet itself can run the files
    other_engines: ClassVar[tuple[str, ...]] = ()  # further engines that read the same files

    def place(self, effect: NamedEffect) -> Place:
        """Where a named effect goes; what acts for a while only goes nowhere."""
        if effect.interval is not None or effect.recording is not None or effect_named(effect.effect).is_transient:
            return PASSING
        return self.place_of_values(effect.effect, effect.values)

    def place_of_values(self, name: str, values: Mapping[str, float]) -> Place:
        """Where an effect with such parameters goes; overridden where that depends on them."""
        return self.places[name]

    def measured(self, effect: str) -> Mapping[str, float]:
        """Measured error of an effect that was written, by engine, in shares of what it moves."""
        return measured_errors(self.name, effect)

    @abstractmethod
    def write(self, arm: ArmPhysics, folder: Path) -> tuple[Path, ...]:
        """Write the model and what belongs to it.

        Returns:
            The files, the one to open first.
        """
