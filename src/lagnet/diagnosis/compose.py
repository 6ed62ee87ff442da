"""Puts what an inquiry found into a verdict."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from lagnet._version import __version__
from lagnet.diagnosis.hum import told_of_hum
from lagnet.diagnosis.leftover import ABOVE, power_of, stacked
from lagnet.diagnosis.localisation import locate
from lagnet.diagnosis.one_clock import told_of_clock
from lagnet.diagnosis.passing_words import changes_in_time, passing_effects, spells_in_fit, told_in_time
from lagnet.diagnosis.problem import Problem
from lagnet.diagnosis.rivals import Contest
from lagnet.diagnosis.tie_advice import recording_against
from lagnet.diagnosis.too_vague import TooVague
from lagnet.diagnosis.verdict import (
    Abstained,
    EffectEvidence,
    EffectFound,
    JointFit,
    JointMismatch,
    NamedParameter,
    Unexplained,
    Verdict,
)
from lagnet.diagnosis.wording import SELDOM_MET, advice, explain
from lagnet.effects.catalogue import effect_named
from lagnet.recordings.recording import Recording

if TYPE_CHECKING:
    from lagnet.diagnosis.inquiry import Inquiry

KINDS = ("urdf", "mjcf", "named_robot", "learned", "corrected")


def compose_verdict(inquiry: Inquiry, fit: Sequence[Recording], held: Sequence[Recording]) -> Verdict:
    """All parts of the verdict."""
    problem = inquiry.problem
    effects = _strongest_first((*_effects(inquiry), *passing_effects(inquiry, fit)))
    conditioning = {
        "rate_hz": inquiry.fit.rate,
        "bandwidth_hz": inquiry.fit.bandwidth,
        "velocity_from": inquiry.fit.velocity_from,
        "acceleration_from": inquiry.fit.acceleration_from,
    }
    mismatch = tuple(_mismatch(inquiry, j) for j in range(problem.n_dof))
    return Verdict(
        lagnet_version=__version__,
        seed=inquiry.seed,
        nominal=nominal_of(problem),
        recordings=(*(_recording(r, "fit") for r in fit), *(_recording(r, "holdout") for r in held)),
        conditioning=conditioning,
        joints=mismatch,
        effects=effects,
        unexplained=tuple(_unexplained(inquiry, j) for j in range(problem.n_dof)),
        fit=tuple(_fit(inquiry, j) for j in range(problem.n_dof)),
        abstentions=_abstentions(inquiry),
        warnings=_warnings(inquiry, fit, held),
    )


def _warnings(inquiry: Inquiry, fit: Sequence[Recording], held: Sequence[Recording]) -> tuple[str, ...]:
    model = inquiry.problem.nominal
    of_model = [f"{getattr(model, 'source', '')}: {w}" for w in getattr(model, "warnings", ())]
    of_files = dict.fromkeys(w for r in (*fit, *held) for w in r.warnings)
    return (
        *of_model,
        *of_files,
        *told_in_time(inquiry, fit, held),
        *told_of_clock(inquiry.fit),
        *told_of_hum(inquiry.fit, inquiry.problem.joints),
    )


def is_prismatic(problem: Problem, joint: int | None) -> bool:
    """Whether a joint slides."""
    kinds = getattr(problem.nominal, "joint_types", None)
    return joint is not None and kinds is not None and kinds[joint] == "prismatic"


def nominal_of(problem: Problem) -> dict[str, Any]:
    """What was held against the recordings."""
    model = problem.nominal
    return {
        "kind": kind if (kind := str(getattr(model, "kind", ""))) in KINDS else "learned",
        "source": str(getattr(model, "source", "") or type(model).__name__),
        "sha256": str(getattr(model, "sha256", "")),
        "joints": list(problem.joints),
    }


def _recording(recording: Recording, role: str) -> dict[str, Any]:
    return {
        "path": recording.path,
        "role": role,
        "sha256": recording.sha256,
        "n_samples": len(recording),
        "duration_s": recording.duration,
        "rate_hz": recording.rate,
    }


def _mismatch(inquiry: Inquiry, joint: int) -> JointMismatch:
    problem = inquiry.problem
    rest, counts = stacked(problem, problem.fit)
    residual = rest[:, joint] * counts[:, joint]
    rms = float(np.sqrt(np.sum(residual**2) / max(1, counts[:, joint].sum())))
    noise = float(inquiry.noise[joint])
    where = locate(problem, residual, joint, is_prismatic(problem, joint), spells_in_fit(inquiry))
    return JointMismatch(
        joint=problem.joints[joint],
        significant=bool(rms > ABOVE * noise),
        residual_rms=rms,
        noise_rms=noise,
        nmse_nominal=float(rms**2 / problem.scale[joint] ** 2),
        where=tuple(asdict(w) for w in where) if rms > ABOVE * noise else (),
    )


def _effects(inquiry: Inquiry) -> tuple[EffectFound, ...]:
    contests = {c.index: c for c in inquiry.contests}
    out = []
    for n, index in enumerate(inquiry.found.selection):
        part = inquiry.held_out[index]
        rival, odds = contests[index].best_rival
        variance = inquiry.problem.scale**2 if part.silent else inquiry.problem.unseen_variance
        evidence = EffectEvidence(*part.of_variance(variance), part.share, rival, odds)
        out.append(_effect(inquiry, n, contests[index], evidence))
    return tuple(out)


def _strongest_first(effects: Sequence[EffectFound]) -> tuple[EffectFound, ...]:
    return tuple(sorted(effects, key=lambda e: -e.evidence.share_of_mismatch))


def _effect(inquiry: Inquiry, n: int, contest: Contest, evidence: EffectEvidence) -> EffectFound:
    named = inquiry.refit.effects[n]
    law = effect_named(named.effect)
    sliding = is_prismatic(inquiry.problem, named.joint)
    parameters = tuple(
        NamedParameter(p.name, float(named.values[p.name]), p.unit_for(sliding), inquiry.refit.intervals[n][p.name])
        for p in law.parameters
    )
    joint = None if named.joint is None else inquiry.problem.joints[named.joint]
    status = "tied" if contest.tied else "named"
    words = explain(law, joint, parameters, contest.tied, evidence)
    words += SELDOM_MET if inquiry.held_out[contest.index].silent else ""
    return EffectFound(law.name, joint, status, contest.tied, parameters, evidence, words)


def _unexplained(inquiry: Inquiry, joint: int) -> Unexplained:
    problem, left = inquiry.problem, inquiry.leftovers[joint]
    depends_on = left.ceiling.depends_on
    if left.above and "time" not in depends_on and changes_in_time(inquiry, joint):
        depends_on = ("time", *depends_on)
    formula = left.shape.formula if left.shape else None
    return Unexplained(problem.joints[joint], left.above, left.share, depends_on, formula)


def _fit(inquiry: Inquiry, joint: int) -> JointFit:
    problem = inquiry.problem
    variance = float(problem.unseen_variance[joint])
    nominal, named = power_of(*stacked(problem, problem.holdout), joint), inquiry.leftovers[joint].power
    floor = float(inquiry.noise[joint] ** 2) / variance
    return JointFit(problem.joints[joint], nominal / variance, named / variance, None, floor)


def _abstentions(inquiry: Inquiry) -> tuple[Abstained, ...]:
    out = []
    for a in inquiry.library.abstentions:
        law = effect_named(a.effect)
        if a.effect == "link_inertia" and a.joint == inquiry.problem.n_dof - 1:
            continue  # the payload stands for it
        joint = None if a.joint is None else inquiry.problem.joints[a.joint]
        out.append(Abstained(a.effect, joint, a.reason, advice(law, joint)))
    return (*(_told_as_vague(inquiry, v) for v in inquiry.vague), *out)


def _told_as_vague(inquiry: Inquiry, vague: TooVague) -> Abstained:
    joint = None if vague.joint is None else inquiry.problem.joints[vague.joint]
    return Abstained(
        vague.effect,
        joint,
        vague.reason,
        "; ".join(dict.fromkeys(recording_against([vague.effect], [t]) for t in vague.tied)),
    )
