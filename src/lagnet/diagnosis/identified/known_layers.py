"""Identified layers of one diagnosis by what they answer: its runs and rules ask for the same one many times."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, field

from lagnet.diagnosis.identified.fit import Identified, identify
from lagnet.diagnosis.problem.problem import Problem
from lagnet.models.corrected.named_effects import NamedEffect


@dataclass(frozen=True, eq=False)
class KnownLayers:
    """Layers that were identified before, on recordings of one rate and bandwidth.

    Args:
        found: by nominal model, samples and effects; the problem keeps alive what the key refers to.
    """

    found: dict[Hashable, tuple[Problem, Identified | None]] = field(default_factory=dict, init=False, repr=False)

    def beside(self, problem: Problem, effects: Sequence[NamedEffect]) -> Identified | None:
        """What the fitted recordings determine beside effects, identified at most once; None where nothing."""
        key = _question(problem, effects)
        if key not in self.found:
            self.found[key] = problem, identify(problem, effects)
        return self.found[key][1]


def _question(problem: Problem, effects: Sequence[NamedEffect]) -> Hashable:
    """All that `identify` reads, arrays of samples by their identity; friction at rest matters to effects alone."""
    samples = tuple(
        (*map(id, (p.time, p.q, p.v, p.a, p.tau)), p.keep.tobytes(), p.counts.tobytes()) for p in problem.fit
    )
    at_rest = problem.held if effects else None
    forms = tuple(None if x is None else x.tobytes() for x in (problem.slow, problem.straight, problem.scale, at_rest))
    return id(problem.nominal), samples, forms, tuple(e.key for e in effects)
