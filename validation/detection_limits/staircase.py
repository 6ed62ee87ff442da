"""Look for the size at which an effect is found: halve it when found, double it when missed, plant by plant."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from validation.detection_limits.plants import Condition

START, FLOOR, ROOF = 0.02, 3e-4, 0.4  # share of the joint's torque
FIRST_FACTOR, FACTOR = 4.0, 2.0
MIDDLE = Condition(0.01, 20.0)
EASIER = (Condition(0.005, 20.0),)
HARDER = (Condition(0.02, 20.0), Condition(0.01, 8.0))
CONDITIONS = (*EASIER, MIDDLE, *HARDER)


@dataclass(frozen=True)
class Trial:
    """One plant under one condition.

    Args:
        number: of the plant.
        noise, duration: the condition.
        size: that was hidden.
        found: whether it was.
        asked: False where the answer follows from another condition: what is missed is missed under a harder one, and
            what is found is found under an easier one.
    """

    number: int
    noise: float
    duration: float
    size: float
    found: bool
    asked: bool = True


def next_size(middle: Sequence[Trial]) -> float:
    """The size to try after these trials under the middle condition."""
    if not middle:
        return START
    turned = any(one.found != other.found for one, other in pairwise(middle))
    factor = FACTOR if turned else FIRST_FACTOR
    last = middle[-1]
    return float(np.clip(last.size / factor if last.found else last.size * factor, FLOOR, ROOF))


def try_plant(found: Callable[[Condition], bool], number: int, size: float, shorter: bool) -> list[Trial]:
    """Trials of one plant under all conditions; those that follow from the middle one are not run.

    Args:
        found: whether the plant's cause is found under a condition.
        shorter: whether recordings may be cut short.
    """

    def trial(condition: Condition, answer: bool, asked: bool = True) -> Trial:
        return Trial(number, condition.noise, condition.duration, size, answer, asked)

    harder = [c for c in HARDER if shorter or c.duration == MIDDLE.duration]
    if found(MIDDLE):
        easy = [trial(c, True, asked=False) for c in EASIER]
        return [trial(MIDDLE, True), *easy, *(trial(c, found(c)) for c in harder)]
    hard = [trial(c, False, asked=False) for c in harder]
    return [trial(MIDDLE, False), *(trial(c, found(c)) for c in EASIER), *hard]


def is_middle(trial: Trial) -> bool:
    """Whether a trial was run under the middle condition."""
    return (trial.noise, trial.duration) == (MIDDLE.noise, MIDDLE.duration)
