"""Torque ripple: a torque that repeats with the angle of motor or gear."""

from collections.abc import Mapping, Sequence
from typing import final

import numpy as np

from lagnet.effects.effect import Effect, Parameter, Values
from lagnet.effects.excitation import needs_position_range
from lagnet.effects.motion import Motion
from lagnet.recordings.sampling import median_step

PER_TURN = (2.0, 400.0)  # periods per radian that are tried at all
RESOLUTION = 0.35  # step of the scan, in periods over the range of the joint
PERIODIC = 0.1  # of the order, the error beyond which it is not known that anything repeats
TOLD = 2  # orders proposed from one residual
SLICE = 64  # orders whose waves are in memory at once


@final
class TorqueRipple(Effect):
    """Magnets, teeth and bearings that are not perfectly round push and pull in turn: r = A sin(N q + φ)."""

    name = "torque_ripple"
    title = "Torque ripple"
    formula = "A sin(N q + φ)"
    parameters = (
        Parameter("N", "N", "1/rad", "periods per 2π of joint angle", lower=0.0),
        Parameter("amplitude", "A", "N m", "amplitude", lower=0.0),
        Parameter("phase", "φ", "rad", "phase at q = 0"),
    )
    shown_by = "a slow sweep over the whole range of the joint, sampled fast enough to resolve the ripple"
    confused_with = ("joint_spring",)
    absent = (("amplitude", 0.0),)
    source = "swevers2007"

    def shapes(self, motion: Motion, joint: int) -> Sequence[Values]:
        return ()  # orders are not guessed: they are proposed from the residual

    def proposals(self, motion: Motion, joint: int, residual: np.ndarray) -> Sequence[Values]:
        q, v = motion.q[:, joint], np.abs(motion.v[:, joint])
        reach = float(np.ptp(q))
        if reach <= 0 or needs_position_range(motion, joint):
            return ()
        step = median_step(motion.time)
        seen = np.quantile(v, 0.3) * step  # of position between samples, when the joint is slow
        highest = min(PER_TURN[1], np.pi / max(seen, 1e-9))
        lowest = max(PER_TURN[0], 2.0 * 2.0 * np.pi / reach)
        if highest <= lowest:
            return ()
        orders = np.arange(lowest, highest, RESOLUTION * 2.0 * np.pi / reach)
        own = residual[:, joint]
        power = _periodogram(q, own - own.mean(), orders)
        found = []
        for _ in range(TOLD):
            best = int(np.argmax(power))
            found.append({"N": float(orders[best])})
            power[np.abs(orders - orders[best]) < 2.0 * 2.0 * np.pi / reach] = 0.0
        return tuple(found)

    def columns(self, motion: Motion, joint: int, shape: Mapping[str, float]) -> np.ndarray:
        angle = shape["N"] * motion.q[:, joint]
        return np.column_stack([np.sin(angle), np.cos(angle)])

    def bounds(self, shape: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        return np.full(2, -np.inf), np.full(2, np.inf)

    def values(self, coefficients: np.ndarray, shape: Mapping[str, float]) -> Values:
        sine, cosine = map(float, coefficients)
        return {
            "N": float(shape["N"]),
            "amplitude": float(np.hypot(sine, cosine)),
            "phase": float(np.arctan2(cosine, sine)),
        }

    def torque(self, motion: Motion, joint: int, values: Mapping[str, float]) -> np.ndarray:
        return values["amplitude"] * np.sin(values["N"] * motion.q[:, joint] + values["phase"])

    def is_determined(self, intervals: Mapping[str, tuple[float, float]]) -> bool:
        low, high = intervals["N"]
        repeats = high - low <= PERIODIC * (high + low)
        return repeats and super().is_determined(intervals)

    def excitation(self, motion: Motion, joint: int) -> str | None:
        return needs_position_range(motion, joint)


def _periodogram(q: np.ndarray, residual: np.ndarray, orders: np.ndarray) -> np.ndarray:
    """|Σ r exp(-i N q)|² at evenly spaced orders N, shape (n_orders,), in slices that bound the memory.

    A slice differs from the first by one factor, exp(-i (N_s - N_0) q), so that few exponentials are computed.
    """
    power = np.empty(orders.size)
    turns = np.exp(-1j * np.outer(orders[:SLICE] - orders[0], q))
    for start in range(0, orders.size, SLICE):
        own = power[start : start + SLICE]
        own[:] = np.abs(turns[: own.size] @ (residual * np.exp(-1j * orders[start] * q))) ** 2
    return power
