"""ε(q, v, a) ≈ r, the residual of the mechanics: trained in stages, used at a joint as far as held-out samples gain.

The mechanics are fixed: ε is a plain regression on their residual, so that it cannot replace mechanics (Wu 2024).
Networks come first, which generalise to other motions; then a process on what they leave, for motion that comes again.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.identified.remainder.networks import fit_networks
from lagnet.diagnosis.identified.remainder.process import fit_process
from lagnet.diagnosis.identified.remainder.samples import RemainderSamples
from lagnet.diagnosis.identified.remainder.settings import RemainderSettings
from lagnet.diagnosis.problem.problem import Problem, Segment, spread_evenly
from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.corrected.remainder.learned import LearnedRemainder, RemainderPart


def learn_remainder(
    problem: Problem,
    model: CorrectedModel,
    seed: int,
    settings: RemainderSettings | None = None,
    floor: np.ndarray | float = 0.0,
) -> LearnedRemainder | None:
    """ε of the fitted recordings; None where no joint's held-out samples gain from it.

    Args:
        problem: the diagnosis' problem.
        model: the mechanics, fixed.
        seed: of the networks.
        settings: size and training.
        floor: shape (dof,), residual up to which nothing is left to learn at a joint [N m].
    """
    settings = settings or RemainderSettings()
    pieces = spread_evenly(problem.fit, 30 * settings.most)
    samples = _samples(problem, model, pieces).thinned(settings.most)
    stages: tuple[Callable[[RemainderSamples], RemainderPart | None], ...] = (
        lambda left: fit_networks(left, seed, settings),
        lambda left: fit_process(left, settings),
    )
    parts: list[RemainderPart] = []
    for fit in stages:
        if np.all(samples.power() <= np.square(floor)):
            break
        part = fit(samples)
        if part is not None:
            parts.append(part)
            samples = samples.without(part)
    return LearnedRemainder(tuple(parts), problem.slow) if parts else None


def _samples(problem: Problem, model: CorrectedModel, pieces: Sequence[Segment]) -> RemainderSamples:
    left = []
    for p in pieces:
        mechanics = replace(model, recording=p.origin)  # with what acts in this recording alone
        left.append(problem.reduce(p, p.tau - mechanics.torque_along(p.time, p.q, p.v, p.a)))
    q, v, a = (np.concatenate([getattr(p, name)[p.keep] for p in pieces]) for name in "qva")
    return RemainderSamples(q, v, a, np.concatenate(left), np.concatenate([p.counts for p in pieces]), problem.slow)
