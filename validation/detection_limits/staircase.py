"""Look for the size at which an effect is found: halve it when found, double it when missed, fit a curve at the end."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

START, FLOOR, ROOF = 0.02, 3e-4, 0.4  # share of the joint's torque
FIRST_FACTOR, FACTOR = 4.0, 2.0
WIDTHS = np.geomspace(0.1, 1.5, 15)  # of the curve, in natural logarithms of the size
PLACES = np.log(np.geomspace(1e-4, 1.5, 97))
LIKELY_WIDTH = 0.4  # a few trials say little about the width: a log-normal prior with a factor of two


@dataclass(frozen=True)
class Trial:
    """One plant: the size that was hidden and whether it was found."""

    size: float
    found: bool


def next_size(trials: Sequence[Trial]) -> float:
    """The size to try after these."""
    if not trials:
        return START
    turned = any(one.found != other.found for one, other in pairwise(trials))
    factor = FACTOR if turned else FIRST_FACTOR
    last = trials[-1]
    return float(np.clip(last.size / factor if last.found else last.size * factor, FLOOR, ROOF))


def climb(attempt: Callable[[int, float], Trial | None], count: int) -> list[Trial]:
    """So many trials; an attempt that finds no such plant gives None and is left out."""
    trials: list[Trial] = []
    for number in range(count):
        trial = attempt(number, next_size(trials))
        if trial is not None:
            trials.append(trial)
    return trials


def limits(trials: Sequence[Trial]) -> dict[str, float | None]:
    """Sizes found in 50 % and 95 % of the plants; None where the effect was found, or missed, every time.

    The curve is logistic in the logarithm of the size; likelihood times prior is averaged over a grid.
    """
    hits = np.array([t.found for t in trials])
    if not hits.size or hits.all() or not hits.any():
        return {"half": None, "most": None}
    sizes = np.log([t.size for t in trials])
    slope = (sizes[:, None, None] - PLACES[None, :, None]) / WIDTHS[None, None, :]
    chance = np.clip(1 / (1 + np.exp(-slope)), 1e-9, 1 - 1e-9)
    fit = np.sum(np.log(np.where(hits[:, None, None], chance, 1 - chance)), axis=0)
    fit = fit - 0.5 * (np.log(WIDTHS / LIKELY_WIDTH) / np.log(2.0)) ** 2
    weight = np.exp(fit - fit.max())
    weight /= weight.sum()
    half = float(np.sum(weight * PLACES[:, None]))
    most = float(np.sum(weight * (PLACES[:, None] + WIDTHS[None, :] * np.log(19.0))))
    return {"half": float(np.exp(half)), "most": float(np.exp(most))}
