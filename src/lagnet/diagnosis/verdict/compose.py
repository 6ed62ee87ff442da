"""Composes the verdict from the state of a diagnosis: mismatch, effects, remainder, errors and abstentions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict

import numpy as np

from lagnet._version import __version__
from lagnet.diagnosis.identifiability.ambiguity import AmbiguousCause
from lagnet.diagnosis.identifiability.recording_advice import recording_against
from lagnet.diagnosis.identifiability.rivals import Comparison
from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.problem.residuals import power_of, stacked
from lagnet.diagnosis.problem.tonal_noise import tonal_noise_words
from lagnet.diagnosis.state import DiagnosisState
from lagnet.diagnosis.unexplained.localisation import locate
from lagnet.diagnosis.verdict.inputs import nominal_entry, recording_entries
from lagnet.diagnosis.verdict.transient_wording import changes_in_time, events_in_fit, transient_effects, words_on_time
from lagnet.diagnosis.verdict.verdict import (
    Abstained,
    EffectEvidence,
    EffectFound,
    JointFit,
    JointMismatch,
    NamedParameter,
    Rejected,
    Unexplained,
    Verdict,
)
from lagnet.diagnosis.verdict.wording import (
    BESIDE_FREE_LINKS,
    SELDOM_MET,
    advice,
    alike_words,
    clock_shift_words,
    explain,
)
from lagnet.effects.catalogue import effect_named
from lagnet.recordings.recording import Recording
from lagnet.types import joint_types_of


def compose_verdict(state: DiagnosisState, fit: Sequence[Recording], held: Sequence[Recording]) -> Verdict:
    """All parts of the verdict."""
    problem = state.problem
    effects = _strongest_first((*_effects(state), *transient_effects(state, fit)))
    conditioning = {
        "rate_hz": state.fit.rate,
        "bandwidth_hz": state.fit.bandwidth,
        "velocity_from": state.fit.velocity_from,
        "velocity_reason": state.fit.velocity_reason,
        "acceleration_from": state.fit.acceleration_from,
    }
    mismatch = tuple(_mismatch(state, j) for j in range(problem.n_dof))
    return Verdict(
        lagnet_version=__version__,
        seed=state.seed,
        nominal=nominal_entry(problem.nominal, problem.joints),
        recordings=recording_entries(fit, held),
        conditioning=conditioning,
        joints=mismatch,
        effects=effects,
        unexplained=tuple(_unexplained(state, j) for j in range(problem.n_dof)),
        fit=tuple(_fit(state, j) for j in range(problem.n_dof)),
        abstentions=_abstentions(state),
        warnings=_warnings(state, fit, held),
        rejected=_rejected(state, effects),
        limits=asdict(problem.limits),
    )


def _rejected(state: DiagnosisState, named: Sequence[EffectFound]) -> tuple[Rejected, ...]:
    """Effects that were considered and not named, each with its last rejection; none that is named in the end."""
    last = {(r.effect, r.joint): r for r in state.rejected}
    rows = ((r, None if r.joint is None else state.problem.joints[r.joint]) for r in last.values())
    places = {(e.effect, e.joint) for e in named}
    return tuple(
        Rejected(r.effect, joint, r.rule, r.value, r.limit, r.detail)
        for r, joint in rows
        if (r.effect, joint) not in places
    )


def _warnings(state: DiagnosisState, fit: Sequence[Recording], held: Sequence[Recording]) -> tuple[str, ...]:
    model = state.problem.nominal
    of_model = [f"{getattr(model, 'source', '')}: {w}" for w in getattr(model, "warnings", ())]
    of_files = dict.fromkeys(w for r in (*fit, *held) for w in r.warnings)
    return (
        *of_model,
        *of_files,
        *words_on_time(state, fit, held),
        *clock_shift_words(state.fit),
        *tonal_noise_words(state.fit, state.problem.joints),
        *(() if state.judged is None else (BESIDE_FREE_LINKS,)),
    )


def is_prismatic(problem: Problem, joint: int | None) -> bool:
    """Whether a joint slides."""
    return joint is not None and joint_types_of(problem.nominal, problem.n_dof)[joint] == "prismatic"


def _mismatch(state: DiagnosisState, joint: int) -> JointMismatch:
    problem = state.problem
    residuals, valid = stacked(problem, problem.fit)
    residual = residuals[:, joint] * valid[:, joint]
    rms = float(np.sqrt(np.sum(residual**2) / max(1, valid[:, joint].sum())))
    noise = float(state.noise[joint])
    where = locate(problem, residual, joint, is_prismatic(problem, joint), events_in_fit(state))
    return JointMismatch(
        joint=problem.joints[joint],
        significant=bool(rms > problem.limits.above_noise * noise),
        residual_rms=rms,
        noise_rms=noise,
        nmse_nominal=float(rms**2 / problem.scale[joint] ** 2),
        where=tuple(asdict(w) for w in where) if rms > problem.limits.above_noise * noise else (),
    )


def _effects(state: DiagnosisState) -> tuple[EffectFound, ...]:
    comparisons = {c.index: c for c in state.comparisons}
    out = []
    for n, index in enumerate(state.selection.indices):
        gain = state.holdout_gain[index]
        rival, odds = comparisons[index].best_rival
        variance = state.problem.scale**2 if gain.silent else state.problem.unseen_variance
        evidence = EffectEvidence(*gain.of_variance(variance), gain.share, rival, odds)
        out.append(_effect(state, n, comparisons[index], evidence))
    return tuple(out)


def _strongest_first(effects: Sequence[EffectFound]) -> tuple[EffectFound, ...]:
    return tuple(sorted(effects, key=lambda e: -e.evidence.share_of_mismatch))


def _effect(state: DiagnosisState, n: int, comparison: Comparison, evidence: EffectEvidence) -> EffectFound:
    named = state.refit.effects[n]
    law = effect_named(named.effect)
    sliding = is_prismatic(state.problem, named.joint)
    parameters = tuple(
        NamedParameter(p.name, float(named.values[p.name]), p.unit_for(sliding), state.refit.intervals[n][p.name])
        for p in law.parameters
    )
    joint = None if named.joint is None else state.problem.joints[named.joint]
    status = "tied" if comparison.tied else "named"
    words = explain(law, joint, parameters, comparison.tied, evidence)
    elsewhere = tuple(state.problem.joints[j] for j in comparison.elsewhere)
    words += alike_words(elsewhere)
    words += SELDOM_MET if state.holdout_gain[comparison.index].silent else ""
    return EffectFound(law.name, joint, status, comparison.tied, parameters, evidence, words, also_at=elsewhere)


def _unexplained(state: DiagnosisState, joint: int) -> Unexplained:
    problem, remainder = state.problem, state.remainders[joint]
    depends_on = remainder.predictability.depends_on
    if remainder.size.above and "time" not in depends_on and changes_in_time(state, joint):
        depends_on = ("time", *depends_on)
    formula = remainder.shape.formula if remainder.shape else None
    return Unexplained(problem.joints[joint], remainder.size.above, remainder.size.share, depends_on, formula)


def _fit(state: DiagnosisState, joint: int) -> JointFit:
    problem = state.problem
    variance = float(problem.unseen_variance[joint])
    nominal, named = power_of(*stacked(problem, problem.holdout), joint), state.sizes[joint].power
    floor = float(state.noise[joint] ** 2) / variance
    return JointFit(problem.joints[joint], nominal / variance, named / variance, None, floor)


def _abstentions(state: DiagnosisState) -> tuple[Abstained, ...]:
    out = []
    for a in state.library.abstentions:
        law = effect_named(a.effect)
        if a.effect == "link_inertia" and a.joint == state.problem.n_dof - 1:
            continue  # the payload is the same law
        joint = None if a.joint is None else state.problem.joints[a.joint]
        out.append(Abstained(a.effect, joint, a.reason, advice(law, joint)))
    return (*(_ambiguous_words(state, v) for v in state.ambiguous), *out)


def _ambiguous_words(state: DiagnosisState, ambiguous: AmbiguousCause) -> Abstained:
    joint = None if ambiguous.joint is None else state.problem.joints[ambiguous.joint]
    return Abstained(
        ambiguous.effect,
        joint,
        ambiguous.reason,
        "; ".join(dict.fromkeys(recording_against([ambiguous.effect], [t]) for t in ambiguous.tied)),
    )
