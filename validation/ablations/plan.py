"""Which plants are asked without what, in which order: so that a run that is stopped has compared like with like."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from validation.ablations.kept_plants import KeptPlant, keep
from validation.ablations.limit_table import LIMITS_OF_RULES, SHARED_LIMITS
from validation.ablations.table import ABLATIONS, Ablation
from validation.texture.plants import RealTexture
from validation.texture.remainders import read_remainders

SIMULATED, TEXTURED = "simulated", "textured"
OF_RULES = tuple(a for a in ABLATIONS if not a.instead)
OF_STEPS = tuple(a for a in ABLATIONS if a.instead)
EVERY = (*ABLATIONS, *SHARED_LIMITS, *LIMITS_OF_RULES)


@dataclass(frozen=True)
class Source:
    """Plants of one kind.

    Args:
        kind: its name.
        seed: of the plants.
        all, few: how many there are, and how many of these are asked for steps and limits as well.
    """

    kind: str
    seed: int
    all: int
    few: int

    def plant(self, number: int, home: Path, data: Path) -> KeptPlant | None:
        """The plant of that number, simulated if it has to be; None where its closed loop is lost."""
        own = home / "plants" / self.kind
        texture = None if self.kind == SIMULATED else RealTexture(read_remainders(data, home / "remainders.npz"))
        try:
            return keep(self.seed, number, own, texture)
        except RuntimeError:
            return None


@dataclass(frozen=True)
class Stage:
    """A pass over plants.

    Args:
        ablations: that each of them is asked under.
        numbers: first and end of the numbers of a source.
    """

    ablations: tuple[Ablation, ...]
    numbers: Callable[[Source], range]


STAGES = (
    Stage((*OF_RULES, *SHARED_LIMITS, *LIMITS_OF_RULES), lambda s: range(s.few)),
    Stage(OF_RULES, lambda s: range(s.few, s.all)),
    Stage(OF_STEPS, lambda s: range(s.few)),
)


def turns(sources: tuple[Source, ...], stage: Stage) -> Iterator[tuple[Source, int]]:
    """Plants of a stage, those of all kinds evenly mixed."""
    numbers = [(s, n) for s in sources for n in stage.numbers(s)]
    share = {s.kind: len(stage.numbers(s)) for s in sources}
    return iter(sorted(numbers, key=lambda x: ((x[1] - stage.numbers(x[0]).start + 0.5) / share[x[0].kind], x[0].kind)))
