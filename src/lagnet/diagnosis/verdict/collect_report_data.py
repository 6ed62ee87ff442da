"""Collects the arrays that a report draws: torque over time, residual against velocity, laws, comparisons of rivals."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from dataclasses import replace
from importlib.metadata import PackageNotFoundError, version
from itertools import pairwise
from typing import Any

import numpy as np

from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.regression.cross_validation import fit_selection
from lagnet.diagnosis.selection.holdout_gain import unseen_nmse
from lagnet.diagnosis.state import DiagnosisState
from lagnet.diagnosis.verdict.arm_motion import arm_motion
from lagnet.diagnosis.verdict.compose import is_prismatic
from lagnet.diagnosis.verdict.report_data import (
    ArmMotion,
    Comparison,
    FrictionLaw,
    HeldOutSeries,
    JointEvidence,
    ReportData,
    ResidualByVelocity,
    SelectionStep,
    Skeleton,
)
from lagnet.effects.catalogue import effect_named
from lagnet.effects.motion import Motion
from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.corrected.named_effects import torque_with
from lagnet.recordings.recording import Recording

PACKAGES = ("numpy", "scipy", "pin", "scikit-learn")
CURVE = 201  # points of a drawn law


def collect_report_data(
    state: DiagnosisState, fit: Sequence[Recording], held: Sequence[Recording], model: CorrectedModel
) -> ReportData:
    """All curves of one diagnosis.

    Args:
        state: what its steps found.
        fit, held: recordings.
        model: the correction with all its layers.
    """
    problem = state.problem
    motions = [replace(p.motion(problem), recorded=None) for p in problem.holdout]
    corrected = [torque_with(m, state.effects) for m in motions]
    full = _all_layers(problem, model)
    return ReportData(
        joints=tuple(_joint(state, corrected, full, held, j) for j in range(problem.n_dof)),
        comparisons=_comparisons(state),
        skeleton=_skeleton(problem),
        motion=_motion(problem, corrected),
        selection=_steps(state),
        settings={"seed": state.seed, "bandwidth_hz": state.fit.bandwidth, "rate_hz": state.fit.rate},
        versions=_versions(),
        checksums={r.path or f"recording {n}": r.sha256 for n, r in enumerate((*fit, *held)) if r.sha256},
    )


def _all_layers(problem: Problem, model: CorrectedModel) -> list[np.ndarray] | None:
    """Low-passed torque of the whole correction on each held-out piece; None where it is the named effects alone."""
    if model.identified is None and model.remainder is None:
        return None
    return [
        problem.reduce(p, replace(model, recording=p.origin).torque_along(p.time, p.q, p.v, p.a))
        for p in problem.holdout
    ]


def _joint(
    state: DiagnosisState,
    corrected: list[np.ndarray],
    full: list[np.ndarray] | None,
    held: Sequence[Recording],
    joint: int,
) -> JointEvidence:
    problem, remainder = state.problem, state.remainders[joint]
    series = [
        (p.time[p.keep], *(problem.reduce(p, x)[:, joint] for x in (p.tau, p.load, c)))
        for p, c in zip(problem.holdout, corrected, strict=True)
    ]
    time, measured, nominal, tau_corrected = (np.concatenate(s) for s in zip(*series, strict=True))
    edges = np.concatenate([[0], np.cumsum([len(s[0]) for s in series])])
    names = tuple(held[p.recording].path or f"recording {p.recording + 1}" for p in problem.holdout)
    v = np.concatenate([p.v[p.keep, joint] for p in problem.holdout])
    return JointEvidence(
        joint=problem.joints[joint],
        unit="N" if is_prismatic(problem, joint) else "N m",
        held_out=HeldOutSeries(
            time,
            measured,
            nominal,
            tau_corrected,
            tuple((int(a), int(b)) for a, b in pairwise(edges)),
            names,
            None if full is None else np.concatenate([x[:, joint] for x in full]),
        ),
        residual=ResidualByVelocity(v, measured - nominal, measured - tau_corrected),
        law=_law(state, joint),
        noise_rms=float(state.noise[joint]),
        predictable_share=remainder.predictability.share if remainder.size.above else None,
        remainder=remainder.shape,
    )


def _law(state: DiagnosisState, joint: int) -> FrictionLaw | None:
    """r(v) = Σ_k r_k(v), the named effects of a joint that are functions of its speed; None without one."""
    problem = state.problem
    own = [e for e in state.refit.effects if e.joint == joint and effect_named(e.effect).function_of_speed]
    if not own:
        return None
    highest = max(float(np.max(np.abs(p.v[:, joint]))) for p in problem.fit)
    v = np.linspace(-highest, highest, CURVE)
    zero = np.zeros((CURVE, problem.n_dof))
    speeds = zero.copy()
    speeds[:, joint] = v
    motion = Motion(
        np.arange(CURVE) * 1e-2, zero, speeds, zero, zero, problem.slow, problem.nominal, straight=problem.straight
    )
    torque = sum((effect_named(e.effect).torque(motion, joint, e.values) for e in own), np.zeros(CURVE))
    return FrictionLaw(tuple(e.effect for e in own), v, torque)


def _comparisons(state: DiagnosisState) -> tuple[Comparison, ...]:
    out = []
    for comparison in state.comparisons:
        h = state.library.hypotheses[comparison.index]
        joint = None if h.joint is None else state.problem.joints[h.joint]
        out.append(Comparison(h.effect, joint, comparison.rivals))
    return tuple(out)


def _skeleton(problem: Problem) -> Skeleton | None:
    """The arm in the middle of its recorded motion."""
    model: Any = problem.nominal
    if not hasattr(model, "skeleton") or not hasattr(model, "joint_axes"):
        return None  # a learned model has no frames
    q = np.median(np.concatenate([p.q for p in problem.fit]), axis=0)
    return Skeleton(model.skeleton(q), model.joint_axes(q))


def _motion(problem: Problem, corrected: list[np.ndarray]) -> ArmMotion | None:
    """The longest held-out motion with its residuals."""
    index = int(np.argmax([len(p.time[p.keep]) for p in problem.holdout]))
    piece = problem.holdout[index]
    tau, nominal, tau_corrected = (problem.reduce(piece, x) for x in (piece.tau, piece.load, corrected[index]))
    scale = np.maximum(np.std(np.concatenate([problem.reduce(p, p.tau) for p in problem.holdout]), axis=0), 1e-12)
    residuals = tau - nominal, tau - tau_corrected
    return arm_motion(problem.nominal, piece.time[piece.keep], piece.q[piece.keep], residuals, scale)


def _steps(state: DiagnosisState) -> tuple[SelectionStep, ...]:
    """The effects from strongest to weakest, with the held-out error of each with all before it."""
    ranked = sorted(state.holdout_gain, key=lambda i: -state.holdout_gain[i].share)
    sigma = np.sqrt(np.maximum(state.selection.fit.sse, 1e-300) / state.equations.samples)
    out = []
    for n, index in enumerate(ranked):
        h = state.library.hypotheses[index]
        fit = fit_selection(state.equations, ranked[: n + 1], sigma, folds=False)
        error = float(np.mean(unseen_nmse(state.equations, fit, state.holdout_equations, state.problem.scale)))
        out.append(SelectionStep(h.effect, None if h.joint is None else state.problem.joints[h.joint], error))
    return tuple(out)


def _versions() -> dict[str, str]:
    found = {"python": platform.python_version()}
    for name in PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found
