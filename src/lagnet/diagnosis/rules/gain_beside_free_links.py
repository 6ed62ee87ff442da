"""Gains that wrong links leave behind: τ_j (1 + w_j) + Y Δπ, with the inertial parameters of all links free.

A model whose links are all too heavy has a gain at a joint as long as few links may change. Each link is felt at all
joints before it, but the gain of a joint at that joint alone: estimated together, gains that stand for links vanish.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, final

import numpy as np

from lagnet.diagnosis.identified.design import FitSegment, make_design
from lagnet.diagnosis.identified.dictionary import CORE, TermGroup
from lagnet.diagnosis.identified.equations import joint_equations
from lagnet.diagnosis.identified.evidence import fit_ridge
from lagnet.diagnosis.identified.fit import fit_segment
from lagnet.diagnosis.problem.problem import spread_evenly
from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule
from lagnet.models.corrected.motion_terms import MotionTerm
from lagnet.models.corrected.named_effects import NamedEffect

MOST_SAMPLES = 60_000  # at full rate: of longer recordings, pieces spread over them
INEFFICIENCY = 10.0  # filtered samples with the information of one
STANDARD_ERRORS = 3.0  # by which the two estimates must differ


@final
@dataclass(frozen=True)
class GainBesideFreeLinks(RejectionRule):
    """Change of the gain beside free inertial parameters of all links, over its deviation from one.

    Args:
        most_change: of g, as a share of |g − 1|.
    """

    name: ClassVar[str] = "gain_beside_free_links"
    statement: ClassVar[str] = "a gain keeps its value beside free inertial parameters of all links"
    source: ClassVar[str] = "gautier1990"

    most_change: float = 0.5

    def rejected(self, candidate: Candidate) -> tuple[Rejection, ...]:
        pairs = zip(candidate.indices, candidate.effects, strict=True)
        gains = {i: e for i, e in pairs if e.effect == "torque_gain" and e.interval is None}
        found = gains_beside_free_links(candidate, list(gains.values())) if gains else []
        rejections = []
        for (index, effect), (free, error) in zip(gains.items(), found, strict=False):
            named = effect.values["g"] - 1.0
            change = abs(free - named)
            if change > max(self.most_change * abs(named), STANDARD_ERRORS * error):
                detail = f"with all links free it is {1.0 + free:.4g} ± {1.96 * error:.2g}, not {1.0 + named:.4g}"
                share = change / max(abs(named), 1e-12)
                rejections.append(self.rejection(candidate, index, share, self.most_change, detail))
        return tuple(sorted(rejections, key=lambda r: -r.value))


def gains_beside_free_links(candidate: Candidate, gains: Sequence[NamedEffect]) -> list[tuple[float, float]]:
    """Deviation w of each gain from one and its standard error, all links free; empty for a model without bodies."""
    problem, segments = candidate.problem, _without(candidate, gains)
    if not segments:
        return []
    friction = [TermGroup("core", tuple(MotionTerm(k, j) for k in CORE), free=True) for j in range(problem.n_dof)]
    scales = [TermGroup("gain", (MotionTerm("gain", int(e.joint or 0)),), free=True) for e in gains]
    design = make_design(problem, segments, [*friction, *scales])
    ridge = fit_ridge(design, joint_equations(design), INEFFICIENCY)
    last = slice(design.n_unknowns - len(gains), None)
    errors = design.unscaled(np.sqrt(np.diag(ridge.covariance)))
    return list(zip(design.unscaled(ridge.x)[last].tolist(), errors[last].tolist(), strict=True))


def _without(candidate: Candidate, gains: Sequence[NamedEffect]) -> list[FitSegment]:
    """Fitted motion with the torque of all effects but the gains as load; none for a model without bodies."""
    problem, others = candidate.problem, [e for e in candidate.effects if not any(e is gain for gain in gains)]
    segments = [fit_segment(problem, p, others) for p in spread_evenly(problem.fit, MOST_SAMPLES)]
    return [replace(s, load=s.piece.tau - s.target) for s in segments if s.regressor is not None]
