"""Collects the curves that a report draws: torque over time, residual against velocity, fitted laws, contests."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from dataclasses import replace
from importlib.metadata import PackageNotFoundError, version
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from lagnet.diagnosis.compose import is_prismatic
from lagnet.diagnosis.evidence import (
    Contest,
    Evidence,
    FrictionLaw,
    HeldOutSeries,
    JointEvidence,
    ResidualByVelocity,
    SelectionStep,
    Skeleton,
)
from lagnet.diagnosis.evidence_of import unseen_nmse
from lagnet.diagnosis.fitting import fit_selection
from lagnet.diagnosis.problem import Problem
from lagnet.effects.catalogue import effect_named
from lagnet.effects.motion import Motion
from lagnet.models.corrected import torque_with
from lagnet.recordings.recording import Recording

if TYPE_CHECKING:
    from lagnet.diagnosis.inquiry import Inquiry

OF_SPEED = (
    "viscous_friction",
    "coulomb_friction",
    "asymmetric_friction",
    "stribeck_friction",
    "quadratic_drag",
    "torque_offset",
)
PACKAGES = ("numpy", "scipy", "pin", "scikit-learn")
CURVE = 201  # points of a drawn law


def collect_evidence(inquiry: Inquiry, fit: Sequence[Recording], held: Sequence[Recording]) -> Evidence:
    """All curves of one diagnosis."""
    problem = inquiry.problem
    motions = [replace(p.motion(problem), recorded=None) for p in problem.holdout]
    corrected = [torque_with(m, inquiry.effects) for m in motions]
    return Evidence(
        joints=tuple(_joint(inquiry, corrected, held, j) for j in range(problem.n_dof)),
        contests=_contests(inquiry),
        skeleton=_skeleton(problem),
        selection=_steps(inquiry),
        settings={"seed": inquiry.seed, "bandwidth_hz": inquiry.fit.bandwidth, "rate_hz": inquiry.fit.rate},
        versions=_versions(),
        checksums={r.path or f"recording {n}": r.sha256 for n, r in enumerate((*fit, *held)) if r.sha256},
    )


def _joint(inquiry: Inquiry, corrected: list[np.ndarray], held: Sequence[Recording], joint: int) -> JointEvidence:
    problem, left = inquiry.problem, inquiry.leftovers[joint]
    series = [
        (p.time[p.keep], *(problem.reduce(p, x)[:, joint] for x in (p.tau, p.load, c)))
        for p, c in zip(problem.holdout, corrected, strict=True)
    ]
    time, measured, nominal, best = (np.concatenate(s) for s in zip(*series, strict=True))
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
            best,
            tuple((int(a), int(b)) for a, b in pairwise(edges)),
            names,
        ),
        residual=ResidualByVelocity(v, measured - nominal, measured - best),
        law=_law(inquiry, joint),
        noise_rms=float(inquiry.noise[joint]),
        ceiling_share=left.ceiling.share if left.above else None,
        leftover=left.shape,
    )


def _law(inquiry: Inquiry, joint: int) -> FrictionLaw | None:
    """The named effects of speed at a joint as one curve."""
    problem = inquiry.problem
    own = [e for e in inquiry.refit.effects if e.joint == joint and e.effect in OF_SPEED]
    if not own:
        return None
    fastest = max(float(np.max(np.abs(p.v[:, joint]))) for p in problem.fit)
    v = np.linspace(-fastest, fastest, CURVE)
    rest = np.zeros((CURVE, problem.n_dof))
    speeds = rest.copy()
    speeds[:, joint] = v
    motion = Motion(
        np.arange(CURVE) * 1e-2, rest, speeds, rest, rest, problem.slow, problem.nominal, straight=problem.straight
    )
    torque = sum((effect_named(e.effect).torque(motion, joint, e.values) for e in own), np.zeros(CURVE))
    return FrictionLaw(tuple(e.effect for e in own), v, torque)


def _contests(inquiry: Inquiry) -> tuple[Contest, ...]:
    out = []
    for contest in inquiry.contests:
        h = inquiry.library.hypotheses[contest.index]
        joint = None if h.joint is None else inquiry.problem.joints[h.joint]
        out.append(Contest(h.effect, joint, contest.rivals))
    return tuple(out)


def _skeleton(problem: Problem) -> Skeleton | None:
    """The arm in the middle of its recorded motion."""
    model = problem.nominal
    try:
        q = np.median(np.concatenate([p.q for p in problem.fit]), axis=0)
        return Skeleton(model.skeleton(q), model.joint_axes(q))
    except AttributeError:
        return None  # a learned model has no bodies


def _steps(inquiry: Inquiry) -> tuple[SelectionStep, ...]:
    """The effects from strongest to weakest, with the held-out error of each with all before it."""
    ranked = sorted(inquiry.held_out, key=lambda i: -inquiry.held_out[i].share)
    sigma = np.sqrt(np.maximum(inquiry.found.fit.sse, 1e-300) / inquiry.bench.samples)
    out = []
    for n, index in enumerate(ranked):
        h = inquiry.library.hypotheses[index]
        fit = fit_selection(inquiry.bench, ranked[: n + 1], sigma, folds=False)
        error = float(np.mean(unseen_nmse(inquiry.bench, fit, inquiry.unseen, inquiry.problem.scale)))
        out.append(SelectionStep(h.effect, None if h.joint is None else inquiry.problem.joints[h.joint], error))
    return tuple(out)


def _versions() -> dict[str, str]:
    found = {"python": platform.python_version()}
    for name in PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found
