"""A small problem, posed as the diagnosis poses it, for the tests of its steps."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from lagnet.diagnosis.arm_search import Found, search_arm
from lagnet.diagnosis.fitting import Workbench, make_workbench
from lagnet.diagnosis.grams import collect_grams
from lagnet.diagnosis.library import Library, build_library
from lagnet.diagnosis.noise_floor import noise_floor
from lagnet.diagnosis.problem import Problem, pose_problem
from lagnet.recordings.conditioning import Conditioned, condition


@dataclass(frozen=True, eq=False)
class Posed:
    """A problem with its evidence.

    Args:
        problem, fit: of the recordings.
        library, bench: hypotheses and normal equations.
        noise: shape (dof,), [N m].
    """

    problem: Problem
    fit: Conditioned
    library: Library
    bench: Workbench
    noise: np.ndarray

    def search(self) -> Found:
        """The selection of the search."""
        return search_arm(self.bench, self.bench.samples * self.noise**2, self.bench.samples * self.problem.scale**2)


def pose(arm: Any, recording: Any, unseen: Any) -> Posed:
    """The first steps of a diagnosis."""
    fit = condition([recording])
    problem = pose_problem(arm, fit, condition([unseen], fit.bandwidth))
    library = build_library(problem)
    bench = make_workbench(library, collect_grams(problem, library, problem.fit))
    return Posed(problem, fit, library, bench, noise_floor(problem, fit, 0))
