"""What lies between the torque that a log holds and the torque at the joint: scale, zero, limit and clock.

A log holds τ_log = (…(g τ + b)…), clipped and late. A simulator that is sent τ_log must apply the τ behind it:
τ = (clip(τ_log) − b) / g, and a torque that the log shows T early (T < 0) must act T later.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np


@dataclass(frozen=True)
class Drive:
    """Signals of one joint, in the order in which the log got them.

    Args:
        gain: logged torque over torque at the joint.
        offset: logged torque where the joint has none [N m].
        lower, upper: logged torque is cut to these [N m].
        lag: time by which the log's torque lags the motion [s]; negative where it leads it.
    """

    gain: float = 1.0
    offset: float = 0.0
    lower: float = -np.inf
    upper: float = np.inf
    lag: float = 0.0

    def scaled(self, gain: float) -> Drive:
        """The log scaled once more."""
        return replace(
            self,
            gain=self.gain * gain,
            offset=self.offset * gain,
            lower=self.lower * gain,
            upper=self.upper * gain,
        )

    def moved(self, offset: float) -> Drive:
        """The log moved by a constant."""
        return replace(self, offset=self.offset + offset, lower=self.lower + offset, upper=self.upper + offset)

    def clipped(self, limit: float) -> Drive:
        """The log cut at ±limit."""
        return replace(self, lower=max(self.lower, -limit), upper=min(self.upper, limit))

    def later(self, lag: float) -> Drive:
        """The log later by `lag`."""
        return replace(self, lag=self.lag + lag)

    @property
    def hold(self) -> float:
        """Time by which a commanded torque acts later than it was logged [s]."""
        return max(0.0, -self.lag)

    @property
    def late(self) -> float:
        """Time by which the read-out of a torque comes later than the torque acts [s]."""
        return max(0.0, self.lag)

    def at_joint(self, logged: np.ndarray | float) -> np.ndarray:
        """Torque at the joint for a torque of the log, without its clock [N m]."""
        return (np.clip(logged, self.lower, self.upper) - self.offset) / self.gain

    def logged(self, torque: np.ndarray | float) -> np.ndarray:
        """Torque of the log for one at the joint, without its clock [N m]."""
        return np.clip(self.gain * np.asarray(torque, dtype=float) + self.offset, self.lower, self.upper)

    @property
    def is_plain(self) -> bool:
        """Whether the log holds the torque at the joint itself."""
        return self == Drive()

    @property
    def most(self) -> float:
        """Largest torque at the joint in either direction, infinite without a limit [N m]."""
        if not np.isfinite(self.upper):
            return float("inf")
        return float(np.max(np.abs((np.array([self.lower, self.upper]) - self.offset) / self.gain)))
