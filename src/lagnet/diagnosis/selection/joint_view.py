"""log P(S) = −(n / 2g) ln E(S) − Σ_k penalty_k of selections of one joint's hypotheses, beside arm-wide ones."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from lagnet.diagnosis.regression.cross_validation import NormalEquations, statistical_inefficiency
from lagnet.diagnosis.regression.joint_system import JointSystem, joint_system
from lagnet.diagnosis.settings import DecisionLimits

Found = TypeVar("Found")


@dataclass(frozen=True, eq=False)
class JointView:
    """Normal equations of one joint after the contributions of arm-wide hypotheses are subtracted.

    Args:
        equations: of the whole arm.
        joint: index.
        system: its normal equations with the residual last, and what was judged on them already.
        inefficiency: samples that make one independent piece of evidence.
        noise_power: squared error that noise alone would leave.
        torque_power: squared torque of the joint, summed over samples.
    """

    equations: NormalEquations
    joint: int
    system: JointSystem
    inefficiency: float
    noise_power: float
    torque_power: float

    @property
    def limits(self) -> DecisionLimits:
        """Where the diagnosis decides."""
        return self.equations.limits

    def error(self, selection: Sequence[int]) -> float:
        """E(S) on blocks left out of the fit [N² m²]."""
        return self.system.judged(selection).error

    def coefficients(self, selection: Sequence[int]) -> np.ndarray:
        """θ of all blocks, in the order of the selection's columns."""
        return self.system.solved(selection)[1]

    def score(self, selection: Sequence[int]) -> float:
        """log P(S) [nats]; −∞ where a coefficient breaks its physical bounds."""
        judged = self.system.judged(selection)
        if not judged.feasible:
            return -np.inf
        evidence = -0.5 * self.pieces * np.log(max(judged.error, self.least_error))
        return float(evidence - self.equations.penalties[list(selection)].sum())

    @property
    def pieces(self) -> float:
        """n / g, independent pieces of evidence."""
        return float(self.equations.samples[self.joint]) / self.inefficiency

    @property
    def least_error(self) -> float:
        """Squared error below which two selections are alike [N² m²]."""
        return float(least_error(self.noise_power, self.torque_power))

    def scores_with_each(self, selection: Sequence[int]) -> np.ndarray:
        """log P(S ∪ {k}) for every hypothesis k of the joint, shape (m,); −∞ where k may not stand beside S."""
        chosen = tuple(sorted(selection))
        return self.remembered(("with each", chosen), lambda: self._scores_with_each(chosen))

    def _scores_with_each(self, selection: tuple[int, ...]) -> np.ndarray:
        errors, feasible = self.system.with_each(selection)
        library = self.equations.library
        local = library.local[self.joint]
        evidence = -0.5 * self.pieces * np.log(np.maximum(errors, self.least_error))
        barred = library.barred[self.joint][:, [local.index(i) for i in selection]].any(axis=1)
        penalties = self.equations.penalties[list(local)] + self.equations.penalties[list(selection)].sum()
        return np.where(feasible & ~barred, evidence - penalties, -np.inf)

    def remembered(self, what: Hashable, make: Callable[[], Found]) -> Found:
        """What `make` finds on this system under these scales, found once."""
        key = (what, self.inefficiency, self.noise_power, self.torque_power)
        if key not in self.system.found:
            self.system.found[key] = make()
        return self.system.found[key]

    def matters(self, selection: Sequence[int], index: int) -> bool:
        """Whether an effect lowers the squared error by enough, compared with E and with the torque, to be claimed."""
        without, with_it = self.error([i for i in selection if i != index]), self.error(selection)
        law, left = self.equations.library.hypotheses[index].law, max(with_it, self.noise_power)
        least = float(self.limits.least_power_of(law, self.torque_power, self.system.power, left))
        return without - with_it > max(self.limits.least_share * without, least)

    @property
    def least_gain(self) -> float:
        """r E_nominal: squared error that an effect must explain to be tested beside larger ones [N² m²]."""
        return self.limits.least_of_residual * self.system.power


def least_error(noise_power: ArrayLike, torque_power: ArrayLike) -> np.ndarray:
    """Squared error below which less is none, of each joint [N² m²]: a thousandth of the noise."""
    return np.maximum(np.maximum(np.multiply(1e-3, noise_power), np.multiply(1e-12, torque_power)), 1e-300)


def view_joint(
    equations: NormalEquations,
    joint: int,
    taken: dict[int, np.ndarray],
    memory: float,
    noise_power: float,
    torque_power: float,
) -> JointView:
    """Normal equations of a joint after the known contributions of arm-wide hypotheses are subtracted."""
    system = joint_system(equations, joint, taken)
    return JointView(equations, joint, system, memory, noise_power, torque_power)


def compatible(view: JointView, selection: Sequence[int], index: int) -> bool:
    """Whether a hypothesis may stand beside the others: not twice the same, nor a law beside its special case."""
    return view.equations.library.may_stand_beside(index, selection)


def joint_inefficiency(view: JointView, selection: Sequence[int]) -> float:
    """g, statistical inefficiency of a selection's residual [samples]."""
    columns = view.equations.columns(view.joint, selection)
    return statistical_inefficiency(view.equations, view.joint, columns, view.coefficients(selection))
