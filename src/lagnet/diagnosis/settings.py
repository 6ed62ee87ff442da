"""Limits that several steps of a diagnosis share; limits of one rule are fields of that rule."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.effects.effect import Effect


@dataclass(frozen=True)
class DecisionLimits:
    """Where a diagnosis decides; passed to `diagnose` and saved with every verdict.

    Args:
        complexity_penalty: nats that a hypothesis must gain: about the logarithm of the number of rivals at a joint.
        penalty_per_coefficient: nats more for each coefficient, beyond what held-out blocks already charge.
        least_share: of the squared error still there, below which an effect is not claimed.
        least_torque: of the standard deviation of a joint's torque, below which an effect is not claimed.
        least_of_residual: of the power of the nominal residual, below which an effect is not claimed.
        least_over_special_case: of what a law explains, that it must gain over its special case, whose form is never
            exact.
        least_ratio: of the held-out errors without and with an effect, from which on it helps.
        tie_odds: log10 odds below which two explanations are tied.
        same_error: relative difference of squared errors below which two explanations are the same, whatever the odds.
        most_names: that one cause may stand for, its own among them, before it is called ambiguous.
        above_noise: root mean square of a residual over that of the noise, from which on a mismatch is significant.
    """

    complexity_penalty: float = 4.0
    penalty_per_coefficient: float = 1.0
    least_share: float = 0.06
    least_torque: float = 0.0075
    least_of_residual: float = 0.0009
    least_over_special_case: float = 0.002
    least_ratio: float = 1.02
    tie_odds: float = 1.3
    same_error: float = 1e-3
    most_names: int = 3
    above_noise: float = 1.25

    def penalty(self, coefficients: int, shapes: int) -> float:
        """Nats that a hypothesis with so many coefficients and shape parameters must gain."""
        return self.complexity_penalty + self.penalty_per_coefficient * (coefficients + shapes)

    def least_power_of(
        self, law: Effect, torque: float | np.ndarray, nominal: float | np.ndarray, left: float | np.ndarray
    ) -> np.ndarray:
        """max(t² P_τ, r P_nominal), shape of the arguments: power that an effect must explain to be claimed [N² m²].

        It guards against bodies, and shares of the load, that stand for a part of a larger cause of their kind. A law
        whose torque is like no load's stands for nothing else where it explains more than all that is left.

        Args:
            torque, nominal: power of a joint's torque about its mean, and of what the nominal model leaves.
            left: power of what all effects leave.
        """
        least = np.maximum(self.least_torque**2 * torque, self.least_of_residual * nominal)
        return np.minimum(least, left) if law.is_like_no_load else least
