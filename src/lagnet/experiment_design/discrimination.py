"""E[log odds] between two tied explanations on a motion that is not recorded yet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.regression.cross_validation import RIDGE, NormalEquations
from lagnet.diagnosis.regression.normal_equations import ridge_solve
from lagnet.diagnosis.selection.arm_search import Selection
from lagnet.experiment_design.open_ties import Explanation, OpenTie

SURE = 2.0  # expected over required log odds: noise reduces the observed ones


@dataclass(frozen=True)
class Separation:
    """Expected evidence of a recording on a tie.

    Args:
        standard_errors: distance of the explanations, the rival refitted to old and new recordings together.
        log10_odds: expected odds of the true explanation over the other, whichever of the two it is.
        margin: expected over required log odds.
    """

    standard_errors: float
    log10_odds: float
    margin: float

    @property
    def breaks(self) -> bool:
        """Whether the recording is expected to break the tie with a safety factor `SURE`."""
        return self.margin >= SURE


def separation(equations: NormalEquations, found: Selection, tie: OpenTie, tables: Sequence[np.ndarray]) -> Separation:
    """min over the rival's shapes, and over which of the two is true, of the expected log odds.

    The rival is fitted to the torque that the truth predicts, on the present recordings and the new motion: the squared
    residual over noise variance and statistical inefficiency is the expected evidence.

    Args:
        equations, found: normal equations and selection of the present recordings, from `open_ties`.
        tie: the two explanations to be distinguished.
        tables: for each joint the reduced columns along the new motion with the residual last, shape (n, width + 1).
    """
    pairs = [(tie.named, other) for other in tie.others] + [(other, tie.named) for other in tie.others]
    comparison = _Comparison(equations, found, tie, tuple(tables))
    return min((comparison.separation(truth, rival) for truth, rival in pairs), key=lambda s: s.margin)


@dataclass(frozen=True, eq=False)
class _Comparison:
    """Expected residuals over old and new samples together."""

    equations: NormalEquations
    found: Selection
    tie: OpenTie
    tables: tuple[np.ndarray, ...]

    @property
    def joints(self) -> tuple[int, ...]:
        """Joints at which the explanations are compared."""
        return self.tie.joints

    def separation(self, truth: Explanation, rival: Explanation) -> Separation:
        grams = {j: self.equations.total[j] + self.tables[j].T @ self.tables[j] for j in self.joints}
        lost = self._lost(grams, truth, rival)
        noise, independent = self._noise()
        distance = {j: lost[j] / (noise[j] * self.found.scales.inefficiency[j]) for j in self.joints}
        nats = sum(0.5 * independent[j] * np.log1p(distance[j] / independent[j]) for j in self.joints)
        odds = float(nats / np.log(10.0))
        margin = odds / self.equations.limits.tie_odds
        if not self.tie.arm_wide:  # errors that are nearly equal are tied whatever the odds
            margin = min(margin, max(lost[j] / self._same(j, grams[j], noise[j]) for j in self.joints))
        return Separation(float(np.sqrt(sum(distance.values()))), odds, float(margin))

    def _same(self, joint: int, gram: np.ndarray, noise: float) -> float:
        """Least difference of squared errors of two explanations that are not equal."""
        n_samples = self.equations.samples[joint] + len(self.tables[joint])
        limits = self.equations.limits
        return max(limits.same_error * noise * n_samples, limits.least_of_residual * gram[-1, -1])

    def _noise(self) -> tuple[np.ndarray, np.ndarray]:
        """Error variance of a sample, and number of independent samples, shape (dof,) each."""
        scales = self.found.scales  # joints at rest have no error, but noise
        power = np.maximum(np.maximum(self.found.fit.sse, scales.noise_power), 1e-12 * scales.torque_power)
        noise = np.maximum(power, 1e-300) / self.equations.samples
        n_samples = self.equations.samples + np.array([len(t) for t in self.tables])
        return noise, n_samples / scales.inefficiency

    def _lost(self, grams: dict[int, np.ndarray], truth: Explanation, rival: Explanation) -> dict[int, float]:
        """min_θ |τ_truth − X θ|² of the rival, refitted, for each joint [N² m²]."""
        (selected, theta), (others, _) = truth, rival
        where_truth, where_rival = self._where(selected), self._where(others)
        size = sum(self.equations.library.widths[i] for i in others)
        gram, moment = np.zeros((size, size)), np.zeros(size)
        noise, _ = self._noise()
        parts = {}
        for j in self.joints:
            mine, theirs = self.equations.columns(j, selected), self.equations.columns(j, others)
            at, to = self._rows(j, selected, where_truth), self._rows(j, others, where_rival)
            inner = grams[j][np.ix_(theirs, theirs)]
            cross = grams[j][np.ix_(theirs, mine)] @ theta[at]
            power = float(theta[at] @ grams[j][np.ix_(mine, mine)] @ theta[at])
            weight = 1.0 / (noise[j] * self.found.scales.inefficiency[j])
            gram[np.ix_(to, to)] += weight * inner
            moment[to] += weight * cross
            parts[j] = (to, inner, cross, power)
        fitted = ridge_solve(gram, moment, RIDGE) if size else np.zeros(0)
        return {
            j: max(0.0, power - 2.0 * float(fitted[to] @ cross) + float(fitted[to] @ inner @ fitted[to]))
            for j, (to, inner, cross, power) in parts.items()
        }

    def _where(self, selection: tuple[int, ...]) -> dict[int, np.ndarray]:
        starts = np.concatenate([[0], np.cumsum([self.equations.library.widths[i] for i in selection])]).astype(int)
        return {i: np.arange(starts[n], starts[n + 1]) for n, i in enumerate(selection)}

    def _rows(self, joint: int, selection: tuple[int, ...], where: dict[int, np.ndarray]) -> np.ndarray:
        own = [where[i] for i in selection if i in self.equations.library.slots[joint]]
        return np.concatenate(own) if own else np.zeros(0, dtype=int)
