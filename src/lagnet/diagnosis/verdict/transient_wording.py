"""Effects and sentences of a verdict on transients, event intervals and drifting friction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.problem.intervals import MOST, EventInterval
from lagnet.diagnosis.state import DiagnosisState
from lagnet.diagnosis.transients.transient import Transient
from lagnet.diagnosis.unexplained.friction_drift import Drift
from lagnet.diagnosis.verdict.verdict import EffectEvidence, EffectFound, NamedParameter
from lagnet.diagnosis.verdict.wording import explain_transient
from lagnet.effects.catalogue import effect_named
from lagnet.effects.inertia.payload import Payload
from lagnet.models.corrected.named_effects import EDGES
from lagnet.recordings.recording import Recording

MOSTLY = 0.5  # of the held-out residual power in events, above which the remainder is reported to depend on time


def transient_effects(state: DiagnosisState, fit: Sequence[Recording]) -> tuple[EffectFound, ...]:
    """The named effects that act on an interval of one fitted recording."""
    half = 0.5 / state.problem.rate  # an edge lies between the last sample outside and the first inside
    return tuple(_effect(t, _name(fit, t.effect.recording or 0), half, _fills(state, t, fit)) for t in state.transients)


def _fills(state: DiagnosisState, transient: Transient, fit: Sequence[Recording]) -> bool:
    """Whether the interval of a transient is the whole of its fitted recording, to a sample of the even clock."""
    (start, end), time = transient.effect.interval or (0.0, 0.0), fit[transient.effect.recording or 0].time
    step = 1.0 / state.problem.rate
    return bool(start <= time[0] + step and time[-1] - step <= end)


def _effect(transient: Transient, recording: str, half: float, throughout: bool) -> EffectFound:
    fit, (start, end) = transient.fit, transient.effect.interval or (0.0, 0.0)
    effect = replace(transient.effect, interval=(start - half, end + half))
    law = effect_named(effect.effect)
    units = {p.name: p.unit for p in law.parameters} | dict.fromkeys(EDGES, "s")
    parameters = tuple(
        NamedParameter(n, float(x), units[n], transient.intervals[n]) for n, x in effect.parameters().items()
    )
    evidence = EffectEvidence(fit.without, fit.with_it, transient.share, fit.rival, fit.odds)
    interval = effect.interval or (0.0, 0.0)
    sentence = explain_transient(law, interval, recording, parameters, fit.tied, evidence, throughout)
    status = "tied" if fit.tied else "named"
    return EffectFound(law.name, None, status, fit.tied, parameters, evidence, sentence, interval, recording)


def words_on_time(state: DiagnosisState, fit: Sequence[Recording], held: Sequence[Recording]) -> tuple[str, ...]:
    """A line on every interval that has no name, and on every friction that drifts."""
    events = [_event_words(s, held if s.held_out else fit) for s in state.events]
    drifts = [_drifting(d, state.problem.joints[d.joint], _name(fit, d.recording)) for d in state.drifts]
    return (*_differences(state, fit), *_loads_of_the_held(state, fit, held), *events, *drifts)


def _differences(state: DiagnosisState, fit: Sequence[Recording]) -> tuple[str, ...]:
    """A line where recordings hold loads of their own: mass and centre in each."""
    own = [t.effect for t in state.transients if _fills(state, t, fit) and t.effect.effect == Payload.name]
    if not own:
        return ()
    loads = [
        f"{e.values['m']:.3g} kg at ({', '.join(f'{e.values[c]:.3g}' for c in ('cx', 'cy', 'cz'))}) m in "
        f"{_name(fit, e.recording or 0)}"
        for e in own
    ]
    beyond = "" if state.judged is None else _beyond_the_others(state, fit, {e.recording or 0 for e in own})
    return (f"the recordings differ from each other: the arm carries {'; '.join(loads)}{beyond}",)


def _beyond_the_others(state: DiagnosisState, fit: Sequence[Recording], loaded: set[int]) -> str:
    """What loads are beyond, where links are fitted beside them: what the other recordings carry is in these links."""
    others = sorted({p.recording for p in state.problem.fit} - loaded)
    names = ", ".join(_name(fit, n) for n in others)
    return f", beyond what it carries in {names}, which its links hold" if others else ""


def _loads_of_the_held(state: DiagnosisState, fit: Sequence[Recording], held: Sequence[Recording]) -> tuple[str, ...]:
    """A line on every held-out recording that carries the load of a fitted one, and is not its end."""
    loaded = {t.effect.recording for t in state.transients if _fills(state, t, fit)}
    origins = ((n, m) for n, m in state.origins.items() if m is not None and m in loaded)
    pairs = [(n, m) for n, m in origins if not _is_end(held[n], fit[m])]
    return tuple(f"{_name(held, n, True)}: held out, it carries the load of {_name(fit, m)}" for n, m in pairs)


def _is_end(held: Recording, fitted: Recording) -> bool:
    return held.path == fitted.path and bool(held.time[0] > fitted.time[-1])


def _drifting(drift: Drift, joint: str, recording: str) -> str:
    way, levels = "falls" if drift.change < 0 else "rises", ", ".join(f"{100.0 * x:.3g}" for x in drift.levels)
    return (
        f"{joint}: friction {way} by {100.0 * abs(drift.change):.2g} ± {196.0 * drift.error:.1g} % over {recording} "
        f"({levels} % of the fitted friction in its quarters), as when a joint warms up; it is fitted as constant"
    )


def _name(recordings: Sequence[Recording], index: int, held_out: bool = False) -> str:
    return recordings[index].path or f"{'held-out ' if held_out else ''}recording {index + 1}"


def _event_words(event: EventInterval, recordings: Sequence[Recording]) -> str:
    time, recording = recordings[event.recording].time, _name(recordings, event.recording, event.held_out)
    if event.held_out and event.end - event.start > MOST * (time[-1] - time[0]):
        return (
            f"{recording} is held out and differs from the fitted recordings from beginning to end: a load or tool on "
            f"the last link is another or mounted otherwise; fitted with the others, each gets a load of its own"
        )
    why = "it lies in a held-out recording and gets no name" if event.held_out else "it has no name"
    return (
        f"{recording}: from {event.start:.4g} s to {event.end:.4g} s something acts on the arm that is absent from the "
        f"rest of the recordings, such as a contact or a load; {why}"
    )


def events_in_fit(state: DiagnosisState) -> tuple[tuple[int, float, float], ...]:
    """Recording, start and end [s] of all transients and events in the fitted recordings."""
    named = [(p.effect.recording or 0, *(p.effect.interval or (0.0, 0.0))) for p in state.transients]
    return (*named, *((s.recording, s.start, s.end) for s in state.events if not s.held_out))


def changes_in_time(state: DiagnosisState, joint: int) -> bool:
    """Whether a joint's remainder depends on time: its friction drifts, or most of it lies in event intervals."""
    drifts = any(d.joint == joint for d in state.drifts)
    return drifts or _share_in_events(state, state.after.holdout[0][:, joint]) > MOSTLY


def _share_in_events(state: DiagnosisState, residual: np.ndarray) -> float:
    """Σ_events r² / Σ r² of a joint's held-out residual r, shape (n,), over intervals without a name."""
    held = [s for s in state.events if s.held_out]
    inside = [
        np.any([(p.recording == s.recording) & (t >= s.start) & (t <= s.end) for s in held], axis=0)
        for p in state.problem.holdout
        for t in (p.time[p.keep],)
        if held
    ]
    power = residual**2
    return float(power[np.concatenate(inside)].sum() / max(power.sum(), 1e-300)) if inside else 0.0
