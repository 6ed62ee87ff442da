"""A run in a narrower band: impacts and resonances drown what holds below them.

Where much is unexplained, narrower bands are tried.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.free_bodies import BETTER, against_given, with_nominal
from lagnet.diagnosis.identified.borne_out import powers_beside
from lagnet.diagnosis.problem.intervals import EventInterval, set_aside
from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.problem.residuals import log_of_powers
from lagnet.diagnosis.reruns.puzzles import fewer_names, is_identified, is_puzzled
from lagnet.diagnosis.state import DiagnosisState
from lagnet.errors import DiagnosisError
from lagnet.models.corrected.named_effects import torque_with

FACTORS = (0.5, 0.25)  # of the bandwidth
LEAST = 2.5  # [Hz]


def best_band(first: DiagnosisState, at: Callable[[float], DiagnosisState]) -> DiagnosisState:
    """The first run, or the one in a narrower band that predicts torque below it much better.

    With as many names, or so much better that each name that is lost is paid for: wrong names of a wider band may be
    more than the cause. What names gain must outweigh what is lost without names: a few seconds of motion in a narrow
    band may show more laws and determine far less of the correction.

    Args:
        at: a run on the same recordings at a given bandwidth [Hz].
    """
    given = against_given(first)
    if not is_puzzled(given) or is_identified(given):
        return first
    tried = [first, *_narrower(first.fit.bandwidth, at)]
    events = [s for one in tried for s in one.events]
    errors = [_error(one, tried[-1], events) for one in tried]
    best = int(np.argmin(errors))
    price = BETTER * (1 + fewer_names(tried[best], first))
    if errors[best] >= errors[0] - price:
        return first
    before, after = (_error_of_layer(one, tried[-1], events) for one in (first, tried[best]))
    return tried[best] if errors[best] + after < errors[0] + before - price else first


def _narrower(bandwidth: float, at: Callable[[float], DiagnosisState]) -> list[DiagnosisState]:
    out = []
    for band in (f * bandwidth for f in FACTORS):
        if band < LEAST:
            break
        try:
            out.append(at(band))
        except DiagnosisError:  # recordings too short for so slow a filter
            break
    return out


def _error(state: DiagnosisState, judge: DiagnosisState, events: Sequence[EventInterval]) -> float:
    """Σ_j ln max(mean r_j², σ_j²) of the names on held-out samples, in the band of another run."""
    problem, rest, counts = _judged(state, judge, events), [], []
    for piece in problem.holdout:
        motion = replace(piece.motion(problem), recorded=None)
        rest.append(problem.reduce(piece, piece.tau - torque_with(motion, state.effects)) * piece.counts)
        counts.append(piece.counts)
    power = np.sum(np.concatenate(rest) ** 2, axis=0) / np.maximum(1, np.concatenate(counts).sum(axis=0))
    return log_of_powers(power, judge.noise)


def _error_of_layer(state: DiagnosisState, judge: DiagnosisState, events: Sequence[EventInterval]) -> float:
    """The same of the identified layer, beside the names or in their place, whichever leaves less."""
    problem = _judged(state, judge, events)
    ways = ((state.effects, state.identified), ((), state.identified_alone))
    layers = [(effects, found.layer) for effects, found in ways if found is not None]
    left = [powers_beside(problem, problem.holdout, *one)[1] for one in layers]
    return min((log_of_powers(power, judge.noise) for power in left), default=_error(state, judge, events))


def _judged(state: DiagnosisState, judge: DiagnosisState, events: Sequence[EventInterval]) -> Problem:
    """The held-out samples in the band of another run, with the friction and the model of this one.

    Event intervals that have no name in any run are not valid in all of them.
    """
    clean = with_nominal(set_aside(judge.problem, events), state.problem.nominal)
    return replace(clean, slow=state.problem.slow, straight=state.problem.straight, held=state.problem.held)
