"""e + F τ_n / σ + J δ: what a fit leaves without one effect n, the others fitted anew along the tangent of the fit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lagnet.diagnosis.estimation.gauss_newton import start_gauss_newton
from lagnet.diagnosis.estimation.superposition import Superposition, reduced
from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.regression.normal_equations import bounded_step, normal
from lagnet.models.corrected.named_effects import NamedEffect


class LeftOut:
    """A fit of all effects, each of which may be left out.

    `pieces` are the segments of the fit; `residuals` those with all effects, shape (len(keep), dof) each, over σ.
    """

    def __init__(self, problem: Problem, effects: Sequence[NamedEffect], sigma: np.ndarray):
        """Makes the fit linear.

        Args:
            problem: as it was fitted.
            effects: as they were fitted, all that were fitted together.
            sigma: shape (dof,), the joints' weights in the fit [N m].
        """
        work, self._x = start_gauss_newton(problem, effects, sigma)
        self._work, self.pieces = work, work.pieces
        self.residuals, self._jacobians = work.linear(self._x)
        self._gram, _ = normal(self._jacobians, self.residuals)
        self._sums = [Superposition(motion, effects) for motion in work.motions]

    def without(self, n: int) -> list[np.ndarray]:
        """Residuals of each segment without effect n, shape (len(keep), dof), over σ."""
        own = self._work.slots.of(n)
        others = np.delete(np.arange(self._x.size), own)
        alone = [self._changed(k, n) for k in range(len(self.pieces))]
        if not others.size:
            return alone
        jacobians = [j[..., others] for j in self._jacobians]
        moment = normal(jacobians, alone)[1]
        lower, upper = (b[others] - self._x[others] for b in self._work.slots.bounds)
        step = bounded_step(self._gram[np.ix_(others, others)], -moment, lower, upper)
        return [e + j @ step for e, j in zip(alone, jacobians, strict=True)]

    def _changed(self, k: int, n: int) -> np.ndarray:
        """Residuals of one segment without effect n, the others as they are."""
        work, piece = self._work, self.pieces[k]
        torque = reduced(work.problem, piece, self._sums[k].without(n))
        return self.residuals[k] - torque * piece.counts / work.sigma
