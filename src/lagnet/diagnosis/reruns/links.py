"""Runs beside the parameters of all links, and beside loads of single recordings, where names leave much."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from lagnet.diagnosis.free_bodies import BETTER, against_given, beside_free_bodies, log_error
from lagnet.diagnosis.identified.borne_out import powers_beside
from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.problem.residuals import log_of_powers
from lagnet.diagnosis.reference_recording import beyond_one_recording
from lagnet.diagnosis.reruns.loads import beside_loads
from lagnet.diagnosis.reruns.puzzles import fewer_names, is_identified, is_outdone, is_puzzled, predicts_better
from lagnet.diagnosis.reruns.transients import settle_transients
from lagnet.diagnosis.rules.surrogate_terms import SurrogateTerms
from lagnet.diagnosis.state import DiagnosisState
from lagnet.types import has_mass

SOME = 0.01  # of a joint's mismatch: if names leave so much, recordings that differ may explain it


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
    if puzzled and not is_puzzled(against_given(second)):
        return second
    return second if not fewer_names(second, first) and predicts_better(second, first) else None


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
    second = beside_loads(first, loads, run)
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
