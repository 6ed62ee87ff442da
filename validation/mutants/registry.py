"""The list of sabotages, and how one is put on it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from validation.mutants.bench import Case


@dataclass(frozen=True)
class Mutant:
    """One sabotage."""

    name: str
    meant_for: str
    what: str
    build: Callable[[], Case]


MUTANTS: list[Mutant] = []


def mutant(meant_for: str) -> Callable[[Callable[[], Case]], Callable[[], Case]]:
    """Register a builder; its name is the mutant's, its docstring says what was done."""

    def register(build: Callable[[], Case]) -> Callable[[], Case]:
        MUTANTS.append(Mutant(build.__name__, meant_for, " ".join((build.__doc__ or "").split()), build))
        return build

    return register
