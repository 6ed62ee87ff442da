"""The exact refit, and what it shows to be nothing: effects that only the linear law seemed to need."""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.arm_search import Found
from lagnet.diagnosis.fitting import Workbench
from lagnet.diagnosis.library import Library
from lagnet.diagnosis.problem import Problem
from lagnet.diagnosis.refit import Refit, refit
from lagnet.diagnosis.refit_work import spread
from lagnet.diagnosis.search import LEAST_OF_ALL, LEAST_TORQUE
from lagnet.diagnosis.settle import without
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected import NamedEffect, torque_with

ROUNDS = 12
UNSURE = 1e-9  # weight of an effect whose intervals all hold the value of its absence


def named_effects(library: Library, found: Found) -> tuple[NamedEffect, ...]:
    """The selection as effects with the search's parameters, in the order of the selection."""
    out = []
    for i in found.selection:
        h = library.hypotheses[i]
        out.append(NamedEffect(h.effect, h.joint, h.law.values(found.fit.coefficients[i], dict(h.shape))))
    return tuple(out)


def refit_and_prune(problem: Problem, bench: Workbench, found: Found) -> tuple[Found, Refit]:
    """Refits by the exact laws and drops, smallest first, effects whose torque is then too small to be claimed."""
    for _ in range(ROUNDS):
        sigma = found.sigma(bench)
        fitted = refit(problem, named_effects(bench.library, found), sigma)
        sizes = sizes_of(problem, fitted.effects)
        for n, (effect, intervals) in enumerate(zip(fitted.effects, fitted.intervals, strict=True)):
            if not effect_named(effect.effect).is_determined(intervals):
                sizes[n] *= UNSURE  # not told from nothing: goes before all others
        smallest = min(range(len(sizes)), key=lambda n: sizes[n], default=None)
        if smallest is None or sizes[smallest] >= 1.0:
            break
        found = without(bench, found, found.selection[smallest])
    return found, fitted


def sizes_of(problem: Problem, effects: tuple[NamedEffect, ...]) -> list[float]:
    """Torque of each effect over the least that may be claimed, at the joint where it is largest."""
    pieces = spread(problem.fit)
    motions = [p.motion(problem) for p in pieces]
    together = [torque_with(m, effects) for m in motions]
    nominal = _mean_square([problem.residual(p) for p in pieces])
    least = np.maximum(LEAST_TORQUE**2 * problem.scale**2, LEAST_OF_ALL * nominal)
    out = []
    for n in range(len(effects)):
        rest = effects[:n] + effects[n + 1 :]
        parts = [problem.reduce(p, t - torque_with(m, rest)) for p, m, t in zip(pieces, motions, together, strict=True)]
        out.append(float(np.max(_mean_square(parts) / least)))
    return out


def _mean_square(parts: list[np.ndarray]) -> np.ndarray:
    return np.mean(np.concatenate(parts) ** 2, axis=0)
