"""Runs without the intervals that pass: persistent effects are found anew, then what happens for a while only."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from lagnet.diagnosis.problem.dry_friction import fit_sign_model
from lagnet.diagnosis.problem.intervals import SMEAR, EventInterval, set_aside, too_much
from lagnet.diagnosis.problem.problem import Problem, blurred_speed
from lagnet.diagnosis.problem.thinning import thinned
from lagnet.diagnosis.reruns.loads import beside_loads, separated
from lagnet.diagnosis.reruns.puzzles import is_puzzled, predicts_better
from lagnet.diagnosis.state import DiagnosisState
from lagnet.diagnosis.transients.detection import Scan, detect_events
from lagnet.diagnosis.transients.differing_recordings import differing_groups, differing_recordings
from lagnet.types import is_robot_model

SUSPECT = 2.0  # times the gain of the next best interval, from which the pipeline is run without the interval
LOOKS = 3  # alternations between event intervals and persistent effects, at most


def settle_transients(state: DiagnosisState, again: Callable[[Problem], DiagnosisState]) -> DiagnosisState:
    """The state as it is where there is no event; else persistent effects without the events, and transients apart.

    Args:
        state: of a run on all samples.
        again: another run on the same recordings with some samples set aside.
    """
    scan = detect_events(state.problem, state.lasting_effects, state.noise, SUSPECT)
    found = _with_events_apart(state, scan, again)
    if not is_puzzled(found) or not is_robot_model(state.problem.nominal):
        return found
    loaded = beside_loads(state, differing_groups(state.problem, scan, state.lasting_effects), again)
    if loaded is None:
        return found
    return loaded if predicts_better(loaded, found) else found


def _with_events_apart(state: DiagnosisState, scan: Scan, again: Callable[[Problem], DiagnosisState]) -> DiagnosisState:
    problem, events, clean = state.problem, scan.events, state
    apart: tuple[EventInterval, ...] = ()
    for _ in range(LOOKS):
        if not events:
            return state
        if too_much(problem, set_aside(problem, events)):
            own = differing_recordings(problem, scan, state.lasting_effects)
            differing, events = beside_loads(state, own, again), _leading(problem, events)
            if differing is not None or not events:
                return differing or replace(state, events=scan.events)
        if events == apart:  # another run would be the same
            break
        apart, masked = events, set_aside(problem, events)
        clean = again(fit_sign_model(replace(masked, slow=blurred_speed(thinned(state.fit)), straight=None, held=None)))
        whole = replace(clean.problem, fit=problem.fit, holdout=problem.holdout)
        scan = detect_events(whole, clean.lasting_effects, state.noise)
        slack = SMEAR / problem.bandwidth
        if all(any(old.covers(new, slack) for old in events) for new in scan.events):
            break
        events = scan.events
    found = separated(replace(clean, problem=whole), scan) if scan.events else replace(clean, problem=whole)
    # Without transients the events were none: beside wrong names, what those lack looks like one.
    return found if found.transients or found.events or predicts_better(found, state) else state


def _leading(problem: Problem, events: tuple[EventInterval, ...]) -> tuple[EventInterval, ...]:
    """The strongest intervals down to the first whose gain is a multiple of the next; none where these are too much.

    What lasts is bent by a strong event, and then differs a little all along the other recordings.
    """
    gains = [e.gain for e in events]
    drops = (k for k in range(1, len(gains)) if gains[k - 1] > SUSPECT * gains[k])
    strongest = events[: next(drops, len(events))]
    return () if too_much(problem, set_aside(problem, strongest)) else strongest
