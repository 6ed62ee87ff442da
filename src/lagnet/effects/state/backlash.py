"""Backlash: a gap between motor and link that the load crosses when it changes sign."""

from collections.abc import Mapping, Sequence
from typing import final

import numpy as np

from lagnet.effects.effect import Parameter, Values
from lagnet.effects.excitation import needs_reversals
from lagnet.effects.gap import lag_in_gap
from lagnet.effects.motion import Motion
from lagnet.effects.slopes import first_order, per_acceleration
from lagnet.effects.transmission import Shift, Transmission

GAPS = tuple(float(h) for h in np.geomspace(5e-4, 0.03, 8))  # [rad] half gaps tried: transmissions of arms
NEAR = (0.6, 1.6)  # a gap between two that are tried shows as a flight of another size, within these
LIGHT = 1e-3  # of the joint's usual inertia: below it, a model's inertia is no inertia


@final
class Backlash(Transmission):
    """The link lies against the flank that its load presses it to, and flies freely across the gap when that changes.

    r = τ(q − x, v − ẋ, a − ẍ) − τ(q, v, a) with x = h sign(τ) on a flank and ẍ = τ / M in between, τ being the load
    of the bodies and M their inertia about the joint. How far a link flies depends on how wide the gap is, so that the
    law is not linear in h.
    """

    name = "backlash"
    title = "Backlash"
    formula = "τ(q − x) − τ(q), x = h sign(τ), ẍ = τ/M between"
    parameters = (Parameter("h", "h", "rad", "half the gap between motor and link", lower=0.0, upper=0.2),)
    shown_by = "loads that change sign often, and reversals"
    confused_with = ("stribeck_friction", "presliding_hysteresis", "time_delay")
    source = "swevers2007"

    def shapes(self, motion: Motion, joint: int) -> Sequence[Values]:
        return tuple({"h": h} for h in GAPS)

    def columns(self, motion: Motion, joint: int, shape: Mapping[str, float]) -> np.ndarray:
        """To first order in x, ẋ and ẍ: a gap is small, and its torque is the exact one once it is refitted."""
        return -first_order(motion, joint, *_lag(motion, joint, shape["h"]))[..., None]

    def bounds(self, shape: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        return np.full(1, NEAR[0]), np.full(1, NEAR[1])

    def values(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> Values:
        return {"h": float(shape["h"])}

    def shift(self, motion: Motion, joint: int, values: Mapping[str, float]) -> Shift:
        lag, speed, acceleration = _lag(motion, joint, values["h"])
        return -lag, -speed, -acceleration

    def excitation(self, motion: Motion, joint: int) -> str | None:
        load = motion.load[:, joint]
        if not min(np.mean(load > 0), np.mean(load < 0)) > 0.02:
            return "the load never changes sign, so that the same flank always carries it"
        return needs_reversals(motion, joint)


def _lag(motion: Motion, joint: int, half_gap: float) -> Shift:
    """x, ẋ and ẍ of the link in its gap, each of shape (n,)."""
    if not half_gap > 0.0:
        rest = np.zeros_like(motion.time)
        return rest, rest, rest
    lag = lag_in_gap(motion.time, motion.load[:, joint] / _inertia(motion, joint), half_gap)
    return lag, np.gradient(lag, motion.time), _second(lag, motion.time)


def _inertia(motion: Motion, joint: int) -> np.ndarray:
    """Inertia of the bodies about the joint while the others are led, shape (n,) [kg m²]."""
    inertia = per_acceleration(motion, joint)[:, joint]
    usual = max(float(np.median(np.abs(inertia))), 1e-12)
    return np.maximum(inertia, LIGHT * usual)


def _second(x: np.ndarray, time: np.ndarray) -> np.ndarray:
    """Second difference: the mean of the second derivative about each sample, impacts and all, shape (n,)."""
    out = np.zeros_like(x)
    if x.size > 2:
        out[1:-1] = np.diff(x, 2) / (time[2:] - time[1:-1]) / (time[1:-1] - time[:-2])
    return out
