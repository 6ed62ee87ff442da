"""Servo laws with a fixed set of free parameters, fitted to rollouts of the whole arm: what a later recording says."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.motion.arm.arm_laws import ArmLaws
from lagnet.diagnosis.motion.arm.carried_body import LoadedArm
from lagnet.diagnosis.motion.arm.fitting import fit_values, sensitivities_of
from lagnet.diagnosis.motion.arm.intervals import half_widths, widening
from lagnet.diagnosis.motion.arm.named_laws import ITERATIONS
from lagnet.diagnosis.motion.arm.rollouts import ArmRuns, runs_to_fit
from lagnet.diagnosis.motion.joint.fitting import free_coordinates
from lagnet.diagnosis.motion.problem import MotionProblem

Group = tuple[str, ...]


@dataclass(frozen=True, eq=False)
class FittedLaws:
    """Laws after a fit of some of their parameters.

    Args:
        laws: shape (dof, len(LAW)).
        half: half-width of the 95 % interval of each free parameter, by joint and name.
        left: error of position of each joint by rollouts, root mean square, shape (dof,) [rad or m].
        share: of a body on the last link, with the half-width of its 95 % interval; None: no body was given.
        wider: for each of `apart`, the largest factor by which it widens the interval of another parameter.
    """

    laws: np.ndarray
    half: dict[tuple[int, str], float]
    left: np.ndarray
    share: tuple[float, float] | None = None
    wider: tuple[float, ...] = ()


def fit_fixed_laws(
    problem: MotionProblem,
    laws: np.ndarray,
    free: Mapping[int, tuple[Group, ...]],
    sizes: Mapping[int, Mapping[str, float]],
    floors: np.ndarray,
    body: np.ndarray | None = None,
    apart: Sequence[tuple[int, tuple[Group, ...]]] = (),
) -> FittedLaws:
    """Levenberg–Marquardt on the free parameters of all joints together, over all recordings of the problem.

    Args:
        problem: commands and motion; all of it is fitted.
        laws: where the fit starts, shape (dof, len(LAW)).
        free: law parameters of each joint that are fitted, those of a group with one value.
        sizes: typical size of every law parameter, of each joint in `free`.
        floors: resolution of the positions of each joint, shape (dof,) [rad or m].
        body: ten inertial parameters, shape (10,), of which the last link carries an unknown share; None: nothing.
        apart: a joint and some of its free groups, each of which is asked how much it widens the others' intervals.
    """
    dof = len(problem.joints)
    runs = ArmRuns(problem, runs_to_fit(problem, max(r.recording for r in problem.runs) + 1), tuple(range(dof)))
    coordinates = {j: free_coordinates(groups, laws[j], dict(sizes[j])) for j, groups in free.items() if groups}
    if not coordinates and body is None:
        return FittedLaws(laws.copy(), {}, _rms(runs.errors(laws)))
    laid = ArmLaws(runs, laws, coordinates)
    arm = laid if body is None else LoadedArm(laid, body)
    coupled = sensitivities_of(arm.errors, arm.sizes, arm.nearest)
    start, slopes = arm.read(), arm.sensitivities  # one rollout for a parameter of every joint
    values = fit_values(arm.errors, slopes, start, arm.sizes, floors, nearest=arm.nearest, iterations=ITERATIONS)
    here = arm.errors(values)
    jacobians = coupled(values, here)
    half, _ = half_widths(here, jacobians, floors, np.diag(arm.sizes))
    names = [(j, name) for j, c in coordinates.items() for name in (g[0] for g in c.groups)]
    columns = [[names.index((j, g[0])) for g in groups] for j, groups in apart]
    wider = tuple(widening(here, jacobians, floors, c) for c in columns)
    of_laws = dict(zip(names, map(float, half), strict=False))
    share = None if body is None else (float(values[-1]), float(half[-1]))
    return FittedLaws(laid.write(values[: len(names)]), of_laws, _rms(here), share, wider)


def _rms(errors: list[np.ndarray]) -> np.ndarray:
    return np.array([np.sqrt(np.mean(e**2)) for e in errors])
