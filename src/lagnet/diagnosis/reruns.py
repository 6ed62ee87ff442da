"""Reruns of the pipeline: in a narrower band, on a shifted clock, and without the intervals that pass.

- Impacts and resonances drown what holds below them: where much is unexplained, narrower bands are tried.
- A torque that is held between samples acts, on average, half a sample later than its stamp, and a log may stamp the
  torque of one control cycle beside the motion of the next. Such a shift is shared by all joints and says how the log
  was made, not what an arm lacks. A shift that other joints deny stays what it is: a delay.
- What happens for a while only is looked for after the persistent effects, which are then found anew without it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.free_bodies import (
    BETTER,
    against_given,
    beside_free_bodies,
    explains,
    log_error,
    with_nominal,
)
from lagnet.diagnosis.identified.borne_out import powers_beside
from lagnet.diagnosis.identified.fit import Identified
from lagnet.diagnosis.problem.dry_friction import fit_sign_model
from lagnet.diagnosis.problem.intervals import SMEAR, EventInterval, set_aside, too_much
from lagnet.diagnosis.problem.problem import Problem, blurred_speed
from lagnet.diagnosis.problem.residuals import log_of_powers
from lagnet.diagnosis.problem.thinning import thinned
from lagnet.diagnosis.reference_recording import beyond_one_recording
from lagnet.diagnosis.rules.surrogate_terms import SurrogateTerms
from lagnet.diagnosis.state import DiagnosisState
from lagnet.diagnosis.transients.detection import Scan, detect_events
from lagnet.diagnosis.transients.differing_recordings import (
    Differing,
    differing_groups,
    differing_recordings,
    lasting_loads,
    without_loads,
)
from lagnet.diagnosis.transients.separation import separate
from lagnet.effects.catalogue import effect_named
from lagnet.errors import DiagnosisError
from lagnet.models.corrected.named_effects import NamedEffect, torque_with
from lagnet.types import has_mass, is_robot_model

PUZZLING = 0.3  # of a joint's mismatch: if so much is unexplained, narrower bands are tried
MUCH = 0.05  # of a joint's mismatch: if names leave so much, links that differ may explain it
SOME = 0.01  # of a joint's mismatch: if names leave so much, recordings that differ may explain it
OUTDONE = 3.0  # times the error beside the links and functions of motion that the recordings determine
CLEARLY = 2.0  # times the noise that it must exceed
FACTORS = (0.5, 0.25)  # of the bandwidth
LEAST = 2.5  # [Hz]
HELD = 0.6  # of a sample: delays up to this may come from torques that are held, or stamped half a cycle off
ALIKE = 0.25  # of the shift by which delays of single joints may differ from it
SUSPECT = 2.0  # times the gain of the next best interval, from which the pipeline is run without the interval
LOOKS = 3  # alternations between event intervals and persistent effects, at most


def beside_links(first: DiagnosisState, run: Callable[[Problem], DiagnosisState]) -> DiagnosisState:
    """The first run, or one beside the parameters of all links where these explain what names leave unexplained.

    Args:
        run: another run on the same recordings against another nominal model.
    """
    best = first
    for beside in (_beside_free_links, _beside_links_and_loads):
        second = beside(best, run)
        if second is not None:
            best = replace(second, rejected=(*best.rejected, *second.rejected))
    return best


def _beside_free_links(first: DiagnosisState, run: Callable[[Problem], DiagnosisState]) -> DiagnosisState | None:
    """A run beside all links that recordings share; None where it explains no more than the first.

    Where no link of the model has mass, one of which a change has a name stands for others, however well it explains.
    What plain terms replaced in the first run is not named beside links that have taken up a part of it.
    """
    puzzled, unknown = is_puzzled(first), not has_mass(first.problem.nominal)
    if first.problem.given is not None or not (unknown or (is_identified(first) if puzzled else is_outdone(first))):
        return None
    free = beside_free_bodies(first.problem, first.noise, first.identified_alone)
    if free is None:
        return None
    second = settle_transients(run(free), run)
    if unknown:
        return second
    if {(e.effect, e.joint) for e in second.refit.effects} & _imitations(first):
        return None
    if puzzled:
        return None if is_puzzled(against_given(second)) else second
    before, after = (log_error(one.after, one.noise) for one in (first, second))
    return second if names_as_many(second, first) and after < before - BETTER else None


def _imitations(state: DiagnosisState) -> set[tuple[str, int | None]]:
    """Effect and joint of what plain terms of no effect replaced."""
    return {(r.effect, r.joint) for r in state.rejected if r.rule == SurrogateTerms.name}


def _beside_links_and_loads(first: DiagnosisState, run: Callable[[Problem], DiagnosisState]) -> DiagnosisState | None:
    """A run beside all links and loads of single recordings, where it tells what puzzles.

    Or where links and functions of motion that all recordings share leave three times as much without the loads.
    """
    if not is_puzzled(first, SOME):
        return None
    given = against_given(first)
    loads = beyond_one_recording(given.problem, first.noise, given.identified_alone)
    second = _beside_loads(first, loads, run)
    if second is None or not second.transients:
        return None
    if is_puzzled(first) and not is_puzzled(against_given(second)):
        return second
    before, after = (_error_beside_layer(one) for one in (first, second))
    return second if after < before - BETTER else None


def _error_beside_layer(state: DiagnosisState) -> float:
    """Σ_j ln max(mean r_j², σ_j²) on held-out motion, beside what the recordings determine without a name."""
    if state.identified is None:
        return log_error(state.after, state.noise)
    layer = state.identified.layer
    _, power = powers_beside(state.problem, state.problem.holdout, state.effects, layer)
    return log_of_powers(power, state.noise)


def best_band(first: DiagnosisState, at: Callable[[float], DiagnosisState]) -> DiagnosisState:
    """The first run, or the one in a narrower band that predicts torque below it much better, with as many names.

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
    return tried[best] if errors[best] < errors[0] - BETTER and names_as_many(tried[best], first) else first


def names_as_many(second: DiagnosisState, first: DiagnosisState) -> bool:
    """Whether another run has at least as many causes: what one joint gains is no reason to forget others."""
    second_has, first_has = (len(one.effects) + len(one.ambiguous) for one in (second, first))
    return second_has >= first_has


def is_puzzled(state: DiagnosisState, much: float = PUZZLING) -> bool:
    """Whether some joint has a large residual share, clearly above the noise; an ambiguous cause is no puzzle."""
    limits = (CLEARLY * state.noise) ** 2
    left = zip(state.sizes_beside_supposed, limits, strict=True)
    return any(joint.above and joint.share > much and joint.power > limit for joint, limit in left)


def is_outdone(state: DiagnosisState) -> bool:
    """Whether the identified layer leaves less than a third of what names leave at a joint where that is much.

    Not beside a body that has a name: a load says more than links that differ.
    """
    if any(effect_named(e.effect).is_body for e in state.effects):
        return False
    sizes = state.sizes_beside_supposed
    much = [j for j, joint in enumerate(sizes) if joint.above and joint.share > MUCH]
    found = state.identified if much else None
    if found is None:
        return False
    _, after = powers_beside(state.problem, state.problem.holdout, state.effects, found.layer)
    return any(after[j] < sizes[j].power / OUTDONE for j in much)


def is_identified(state: DiagnosisState) -> bool:
    """Whether bodies and functions of motion without a name explain what is left: then nothing drowns what holds.

    Beside the names, or in their place: a wrong name leaves to the layer what it is not.
    """
    return _explains(state, state.effects, state.identified) or _explains(state, (), state.identified_alone)


def _explains(state: DiagnosisState, effects: Sequence[NamedEffect], found: Identified | None) -> bool:
    """Whether effects and the layer beside them explain the held-out recordings."""
    return found is not None and explains(state.problem, state.problem.holdout, effects, found.layer, state.noise)


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
    """Σ_j ln max(mean r_j², σ_j²) on held-out samples, in the band of another run.

    Event intervals that have no name in any run are not valid in all of them.
    """
    clean = set_aside(judge.problem, events)
    clean = with_nominal(clean, state.problem.nominal)
    problem = replace(clean, slow=state.problem.slow, straight=state.problem.straight, held=state.problem.held)
    rest, counts = [], []
    for piece in problem.holdout:
        motion = replace(piece.motion(problem), recorded=None)
        rest.append(problem.reduce(piece, piece.tau - torque_with(motion, state.effects)) * piece.counts)
        counts.append(piece.counts)
    power = np.sum(np.concatenate(rest) ** 2, axis=0) / np.maximum(1, np.concatenate(counts).sum(axis=0))
    return log_of_powers(power, judge.noise)


def on_one_clock(first: DiagnosisState, shifted: Callable[[float], DiagnosisState]) -> DiagnosisState:
    """The first run, or the one with torques read at shifted times where all joints share a shift within a sample.

    Args:
        shifted: a run on the same recordings, torques read that much later [s].
    """
    delays = _delays(first)
    small = [t for t in delays.values() if abs(t) <= HELD / first.fit.rate]
    if not small:
        return first
    shift = float(np.median(small))
    if any(abs(t - shift) > ALIKE * abs(shift) for t in small):
        return first
    second = shifted(shift)
    others = [j for j in range(first.problem.n_dof) if j not in delays]
    saved = len(delays) - len(_delays(second))  # one shift in the place of many delays is worth what each of them cost
    asked = first.problem.limits.complexity_penalty * (2 - saved)
    return second if not others or _clock_gain(first, second, others) > asked else first


def _delays(state: DiagnosisState) -> dict[int, float]:
    """Delay of each joint that has one by name [s]."""
    found = (e for e in state.effects if effect_named(e.effect).is_delay)
    return {e.joint: e.values["T"] for e in found if e.joint is not None}


def _clock_gain(first: DiagnosisState, second: DiagnosisState, joints: list[int]) -> float:
    """½ Σ_j n_j / g_j ln(E_first / E_second) [nats] on held-out motion, over joints without a delay."""
    samples = first.holdout_equations.samples / first.selection.scales.inefficiency
    before, after = (
        np.maximum([left.power for left in one.sizes], np.maximum(first.noise, 1e-12) ** 2 / 4)
        for one in (first, second)
    )
    return float(0.5 * np.sum((samples * np.log(before / after))[joints]))


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
    loaded = _beside_loads(state, differing_groups(state.problem, scan, state.lasting_effects), again)
    if loaded is None:
        return found
    before, after = (log_error(one.after, one.noise) for one in (found, loaded))
    return loaded if after < before - BETTER else found


def _with_events_apart(state: DiagnosisState, scan: Scan, again: Callable[[Problem], DiagnosisState]) -> DiagnosisState:
    problem, events, clean = state.problem, scan.events, state
    apart: tuple[EventInterval, ...] = ()
    for _ in range(LOOKS):
        if not events:
            return state
        if too_much(problem, set_aside(problem, events)):
            own = differing_recordings(problem, scan, state.lasting_effects)
            differing, events = _beside_loads(state, own, again), _leading(problem, events)
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
    found = _separated(replace(clean, problem=whole), scan) if scan.events else state
    return found if found.transients or found.events else state


def _leading(problem: Problem, events: tuple[EventInterval, ...]) -> tuple[EventInterval, ...]:
    """The strongest intervals down to the first whose gain is a multiple of the next; none where these are too much.

    What lasts is bent by a strong event, and then differs a little all along the other recordings.
    """
    gains = [e.gain for e in events]
    drops = (k for k in range(1, len(gains)) if gains[k - 1] > SUSPECT * gains[k])
    strongest = events[: next(drops, len(events))]
    return () if too_much(problem, set_aside(problem, strongest)) else strongest


def _beside_loads(
    state: DiagnosisState, found: Differing | None, again: Callable[[Problem], DiagnosisState]
) -> DiagnosisState | None:
    """Persistent effects beside the loads of single recordings; None where there are none."""
    if found is None:
        return None
    problem = found.problem
    clean = again(without_loads(problem, found.loads))
    whole = replace(clean.problem, fit=problem.fit, holdout=problem.holdout)
    parts = _separated(replace(clean, problem=whole), found.scan)
    return replace(parts, transients=lasting_loads(whole, parts.transients), events=())


def _separated(clean: DiagnosisState, scan: Scan) -> DiagnosisState:
    power = np.maximum(clean.selection.fit.sse, clean.selection.scales.noise_power)
    sigma = np.sqrt(power / clean.equations.samples)
    parts = separate(clean.problem, clean.refit.effects, sigma, scan)
    return replace(clean, refit=parts.refit, transients=parts.transients, events=parts.unnamed)
