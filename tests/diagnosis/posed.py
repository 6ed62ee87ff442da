"""A small problem, posed as the diagnosis poses it, for the tests of its steps."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from validation.real_arms.rough import kilograms

from lagnet.diagnosis.problem.noise_floor import noise_floor
from lagnet.diagnosis.problem.problem import Problem, pose_problem
from lagnet.diagnosis.regression.block_gram import collect_block_grams
from lagnet.diagnosis.regression.cross_validation import NormalEquations, fit_selection, sum_normal_equations
from lagnet.diagnosis.regression.excited_hypotheses import build_library
from lagnet.diagnosis.regression.library import Library
from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.selection.arm_search import FIRST_INEFFICIENCY, Scales, Selection, refit_selection, search_arm
from lagnet.recordings.conditioning.condition import Conditioned, condition


@dataclass(frozen=True, eq=False)
class Posed:
    """A problem with its evidence.

    Args:
        problem, fit: of the recordings.
        library, equations: hypotheses and normal equations.
        noise: shape (dof,), [N m].
    """

    problem: Problem
    fit: Conditioned
    library: Library
    equations: NormalEquations
    noise: np.ndarray

    def search(self) -> Selection:
        """The selection of the search."""
        return self._searched

    @cached_property
    def _searched(self) -> Selection:
        samples = self.equations.samples
        return search_arm(self.equations, samples * self.noise**2, samples * self.problem.scale**2)

    @cached_property
    def holdout_equations(self) -> NormalEquations:
        """Normal equations of the held-out recording."""
        return sum_normal_equations(self.library, collect_block_grams(self.problem, self.library, self.problem.holdout))

    def index(self, effect: str, joint: int | None) -> int:
        """Number in the library of the first hypothesis of an effect at a joint."""
        return next(i for i, h in enumerate(self.library.hypotheses) if h.place == (effect, joint))

    def select(self, local: Mapping[int, Sequence[str]], arm_wide: Sequence[str] = ()) -> Selection:
        """A selection of exactly these effects, whether the search would choose them or not; nothing is searched.

        Args:
            local: by joint, names of effects that stay there.
            arm_wide: names of effects of the whole arm.
        """
        own = tuple(tuple(self.index(n, j) for n in local.get(j, ())) for j in range(self.problem.n_dof))
        far = tuple(self.index(n, None) for n in arm_wide)
        samples, n = self.equations.samples, self.problem.n_dof
        scales = Scales(np.full(n, FIRST_INEFFICIENCY), samples * self.noise**2, samples * self.problem.scale**2)
        plain = fit_selection(self.equations, (), self.problem.scale)
        first = refit_selection(self.equations, Selection(far, own, -np.inf, plain, scales))
        return refit_selection(self.equations, first)  # joints weighted by what is left of each

    def candidate(self, selection: Selection) -> Candidate:
        """A selection as the rules see it."""
        return Candidate(self.problem, self.equations, self.holdout_equations, selection, self.noise, 0)


def pose(arm: Any, recording: Any, unseen: Any) -> Posed:
    """The first steps of a diagnosis."""
    fit = condition([recording])
    problem = pose_problem(arm, fit, condition([unseen], fit.bandwidth))
    library = build_library(problem)
    equations = sum_normal_equations(library, collect_block_grams(problem, library, problem.fit))
    return Posed(problem, fit, library, equations, noise_floor(problem, fit, 0))


def of_one_mass(robot: Any, mass: float) -> Any:
    """A robot whose links have one mass [kg] each at the origin of their joint, as templates of robot files have."""
    return robot.with_inertial_parameters(mass * kilograms(robot, np.random.default_rng(0)))
