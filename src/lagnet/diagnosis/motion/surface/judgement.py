"""A level surface under the arm, against the same correction without one, by rollouts of the whole arm.

A table pushes several joints at once, only in low poses and only upwards: no law of a servo does, and joint by joint it
is told as friction. It is fitted to the fitted recordings and judged on others: each half of them by the other half,
and the recordings that are held out.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.motion.arm.fitting import cost_of, robust_scales, sensitivities_of
from lagnet.diagnosis.motion.arm.intervals import half_widths
from lagnet.diagnosis.motion.arm.rollouts import ArmRuns, runs_held_out
from lagnet.diagnosis.motion.joint.joint_case import SelectionLimits
from lagnet.diagnosis.motion.joint.joint_diagnosis import JointDiagnosis
from lagnet.diagnosis.motion.problem import MotionProblem
from lagnet.diagnosis.motion.surface.evidence import LEAST_JOINTS, Touched, pushed_joints, together, touched
from lagnet.diagnosis.motion.surface.fit import (
    MOST_LOG_HARDNESS,
    coordinates_of,
    fit_surfaces,
    possible_surface,
    sizes_of_surface,
    surface_errors,
    surface_of,
)
from lagnet.diagnosis.motion.surface.found import SurfaceFound
from lagnet.diagnosis.motion.surface.free_motion import FreeMotion, free_motion
from lagnet.diagnosis.motion.surface.profile import HEIGHT, RISE, Profile, profile_of
from lagnet.diagnosis.motion.surface.starts import lowest_runs, reach_of, starts_of_surface
from lagnet.rollout.surface import BODY, heights_of
from lagnet.servos.parameters import GAP, STIFFNESS
from lagnet.side_by_side import side_by_side

FEW = 4  # iterations on half of the runs
NAMES = ("px", "py", "pz", "h", "k", "mu")


def judge_surface(
    problem: MotionProblem,
    fitted: int,
    laws: np.ndarray,
    found: Mapping[int, JointDiagnosis],
    body: np.ndarray | None,
    limits: SelectionLimits,
) -> SurfaceFound | None:
    """The surface that the arm touches, named or not; None where motion that was not fitted asks for none.

    Args:
        problem: all recordings, the first `fitted` of them fitted.
        fitted: number of them.
        laws: of the nominal servos, shape (dof, len(LAW)).
        found: diagnoses of the joints, with their complete laws.
        body: shape (10,), carried by the last link, or None.
        limits: where effects are named.
    """
    corrected = laws.copy()
    for joint, d in found.items():
        corrected[joint] = d.law
    floors = np.array([d.case.floor for d in found.values()])
    data = ArmRuns(problem, lowest_runs(problem, fitted), tuple(found))
    free = free_motion(data, corrected, body)
    if not _may_touch(free, floors, limits):
        return None
    nominal = laws.copy()
    for joint, d in found.items():
        nominal[joint] = d.nominal
    starts = starts_of_surface(problem, fitted, corrected)
    held = free_motion(ArmRuns(problem, runs_held_out(problem, fitted), tuple(found)), corrected, body)
    before = held.data.errors(nominal)

    def evidence_of(surface: np.ndarray) -> _Judged:
        own = [s for s in starts if s[BODY] == surface[BODY]]
        whole = touched(before, held, surface, floors)
        halves = _by_halves(free, nominal, surface, own, floors) if whole.left <= 1.0 else []
        return _Judged(surface, together([whole, *(t for t, _ in halves)]), [s for _, s in halves])

    judged = side_by_side(evidence_of, fit_surfaces(free, starts, floors))
    judged = [j for j in judged if j.evidence.helps(limits)]
    if not judged:
        return None
    most = (1.0 + RISE) * min(j.evidence.left for j in judged)
    walked = [_walked(free, held, j, floors) for j in judged if j.evidence.left <= most]
    best = _least([j.surface for j, _ in walked], held, floors)
    profiles = [profile for _, profile in walked]
    return _found(free, walked[best][0], [profiles.pop(best), *profiles], floors, limits, found)


@dataclass(frozen=True, eq=False)
class _Judged:
    """A surface, the evidence for it, and those that halves of the runs give."""

    surface: np.ndarray
    evidence: Touched
    halves: list[np.ndarray]


def _walked(free: FreeMotion, held: FreeMotion, judged: _Judged, floors: np.ndarray) -> tuple[_Judged, Profile]:
    """A surface at the best of its heights, where held-out motion is predicted as well there, and the profile."""
    profile = profile_of(free, judged.surface, floors)
    finer = surface_of(judged.surface[BODY], profile.best)
    least = _least([finer, judged.surface], held, floors)
    return replace(judged, surface=(finer, judged.surface)[least]), profile


def _least(surfaces: Sequence[np.ndarray], held: FreeMotion, floors: np.ndarray) -> int:
    """Place of the surface that predicts held-out motion best, the first of equals."""
    errors = [held.errors(s) for s in surfaces]
    scales = robust_scales(errors[-1], floors)
    return int(np.argmin([cost_of(e, scales) for e in errors]))


def _may_touch(free: FreeMotion, floors: np.ndarray, limits: SelectionLimits) -> bool:
    """Whether there is weight, more than one joint, no motor apart from its link, and an error left in low poses."""
    data = free.data
    if len(data.joints) < 2 or not np.any(data.problem.tree.gravity) or free.laws[:, [STIFFNESS, GAP]].any():
        return False
    left = [float(np.sqrt(np.mean(e**2))) for e in free.errors()]
    return any(e > limits.unexplained * f for e, f in zip(left, floors, strict=True))


def _by_halves(
    free: FreeMotion, nominal: np.ndarray, surface: np.ndarray, starts: list[np.ndarray], floors: np.ndarray
) -> list[tuple[Touched, np.ndarray]]:
    """Evidence on each half of the fitted runs from a surface fitted to the other, and that one; none of one run."""
    parts, out = _halves(free.data, surface), []
    if not all(part.runs for part in parts):
        return []
    halves = [free_motion(part, free.laws, free.body) for part in parts]
    for fit, other in (halves, halves[::-1]):
        before = other.data.errors(nominal)
        for found in fit_surfaces(fit, starts, floors, FEW):
            out.append((touched(before, other, found, floors), found))
    return out


def _halves(data: ArmRuns, surface: np.ndarray) -> tuple[ArmRuns, ArmRuns]:
    """Two parts of the runs, each with half of the recordings that come lowest; of one recording, half of its runs."""
    q = np.column_stack([s.q for s in data.problem.series])
    z = heights_of(data.problem.tree, surface, q)
    lowest: dict[int, float] = {}
    alone = len({run.recording for run in data.runs}) == 1
    keys = [i if alone else run.recording for i, run in enumerate(data.runs)]
    for key, run in zip(keys, data.runs, strict=True):
        lowest[key] = min(lowest.get(key, np.inf), float(z[run.first : run.last + 1].min()))
    order = sorted(lowest, key=lambda key: lowest[key])
    sides = ([run for key, run in zip(keys, data.runs, strict=True) if key in order[i::2]] for i in (0, 1))
    first, second = (replace(data, runs=tuple(side)) for side in sides)
    return first, second


def _found(
    free: FreeMotion,
    judged: _Judged,
    profiles: Sequence[Profile],
    floors: np.ndarray,
    limits: SelectionLimits,
    found: Mapping[int, JointDiagnosis],
) -> SurfaceFound:
    """The surface with its intervals; profiles: its own, then those of other bodies that predict about as well."""
    data, surface, evidence = free.data, judged.surface, judged.evidence
    x = coordinates_of(surface)
    half = _half_widths(free, judged, floors)
    (low, high), *others = (profile.ends() for profile in profiles)
    lower, upper = np.minimum(x - half, low), np.maximum(x + half, high)
    for low, high in others:  # their points are in another frame
        lower[HEIGHT], upper[HEIGHT] = min(lower[HEIGHT], low[HEIGHT]), max(upper[HEIGHT], high[HEIGHT])
    values: dict[str, float] = dict(zip(NAMES, map(float, surface[1:]), strict=True))
    ends: dict[str, tuple[float, float]] = {
        n: (float(a), float(b)) for n, a, b in zip(NAMES, lower, upper, strict=True)
    }
    ends["mu"] = (max(0.0, ends["mu"][0]), ends["mu"][1])
    ends["k"] = (float(np.exp(ends["k"][0])), float(np.exp(min(ends["k"][1], MOST_LOG_HARDNESS))))
    squares = evidence.squares.sum(axis=0)
    variance = max(float(np.mean([np.var(data.problem.series[j].q) for j in data.joints])), 1e-12)
    power = squares[1:] / (len(evidence.squares) * len(data.joints) * variance)
    share = float(np.clip((squares[1] - squares[2]) / max(squares[0], 1e-300), 0.0, 1.0))
    name = data.problem.joints[int(surface[BODY])]
    scale = all(d.case.scale_is_set for d in found.values())
    sides = (float(power[0]), float(power[1]))
    pushed = pushed_joints(data.problem.tree, surface, np.column_stack([s.q for s in data.problem.series]))
    named = evidence.is_named(limits) and pushed >= LEAST_JOINTS
    return SurfaceFound(surface, name, values, ends, named, pushed, evidence.gain[1], sides, share, scale)


def _half_widths(free: FreeMotion, judged: _Judged, floors: np.ndarray) -> np.ndarray:
    """Half-widths of 95 % intervals of x, shape (6,): by rollouts, and by how far the two halves of the runs differ.

    What a surface leaves out moves point and height by more than scatter says, and otherwise in each half; their
    difference is two standard errors of the whole.
    """
    x, reach = coordinates_of(judged.surface), reach_of(free.data.problem.tree)
    sizes, errors = sizes_of_surface(reach), surface_errors(free, judged.surface[BODY])
    here = errors(x)
    left = robust_scales(here, floors)  # the laws err to one side over a contact, as half a step of an encoder does
    half, unseen = half_widths(here, sensitivities_of(errors, sizes, possible_surface)(x, here), left, np.diag(sizes))
    apart = [coordinates_of(s) for s in judged.halves]
    between = np.ptp(apart, axis=0) if len(apart) == 2 else 2.0 * np.abs([a - x for a in apart]).sum(axis=0)
    return half + between + np.abs(np.diag(sizes) @ unseen).sum(axis=1) * reach / sizes
