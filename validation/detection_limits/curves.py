"""Logistic curves over the size for each condition of an effect; few plants are enough where all share one curve."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.special import expit

from validation.detection_limits.plants import Condition
from validation.detection_limits.staircase import MIDDLE, Trial

PLACES = np.log(np.geomspace(1e-4, 1.5, 73))  # of the middle condition's half, in natural logarithms of the size
WIDTHS = np.geomspace(0.1, 1.5, 9)
LIKELY_WIDTH = 0.4  # a few trials say little about the width: a log-normal prior with a factor of two
BY_NOISE = np.linspace(0.0, 1.5, 7)  # power of the noise that the size grows with
BY_LENGTH = np.linspace(0.0, 1.5, 7)  # power of the length that it falls with
LIKELY_POWER = 0.5  # both with a half-normal prior of this scale
ODD = 1e-3  # chance of a plant whose answers go against the order of the conditions
MOST = np.log(19.0)  # widths from half to 95 %


def limits(trials: Sequence[Trial], conditions: Sequence[Condition]) -> list[dict]:
    """Sizes found in 50 % and 95 % of the plants, and the interval that holds the first with 90 %, by condition.

    Each plant has a limit of its own, whose logarithm is logistic about half + noise power × log(noise) − length power
    × log(length): its answers under all conditions are one observation, that this limit lies between two sizes.
    Likelihood times prior is averaged over a grid. None where the effect was found, or missed, every time.
    """
    hits = np.array([t.found for t in trials])
    if not hits.size or hits.all() or not hits.any():
        return [_told(c, None, None, (None, None)) for c in conditions]
    place, width, noise, length = np.meshgrid(PLACES, WIDTHS, BY_NOISE, BY_LENGTH, indexing="ij")
    weight = np.zeros(place.shape)
    for number in {t.number for t in trials}:
        below, above = np.full(place.shape, -np.inf), np.full(place.shape, np.inf)
        for t in trials:
            if t.number == number:
                at = (np.log(t.size) - _half(place, noise, length, Condition(t.noise, t.duration))) / width
                below, above = (below, np.minimum(above, at)) if t.found else (np.maximum(below, at), above)
        weight += np.log(np.maximum(expit(above) - expit(below), ODD))
    weight -= 0.5 * (np.log(width / LIKELY_WIDTH) / np.log(2.0)) ** 2
    weight -= 0.5 * (noise / LIKELY_POWER) ** 2 + 0.5 * (length / LIKELY_POWER) ** 2
    weight = np.exp(weight - weight.max())
    weight /= weight.sum()
    out = []
    for c in conditions:
        half = _half(place, noise, length, c)
        mean, most = np.sum(weight * half), np.sum(weight * (half + MOST * width))
        out.append(_told(c, mean, most, _interval(half.ravel(), weight.ravel())))
    return out


def _half(place: np.ndarray, noise: np.ndarray, length: np.ndarray, c: Condition) -> np.ndarray:
    return place + noise * np.log(c.noise / MIDDLE.noise) - length * np.log(c.duration / MIDDLE.duration)


def _interval(values: np.ndarray, weight: np.ndarray) -> tuple[float, float]:
    order = np.argsort(values)
    below = np.cumsum(weight[order])
    low, high = (values[order][np.searchsorted(below, p)] for p in (0.05, 0.95))
    return float(low), float(high)


def _told(c: Condition, half, most, interval: tuple) -> dict:
    low, high, half, most = (None if x is None else float(np.exp(x)) for x in (*interval, half, most))
    return {"noise": c.noise, "duration": c.duration, "half": half, "half_between": [low, high], "most": most}
