"""argmin over a point mass at the last link of the motion of all joints, their laws held.

    M_ii + ΔM_ii, load_i + Δload_i,  Δ = Y_last(q, v, a) π,  π = (m, h, (|h|² 1 − h hᵀ)/m),  h = m c

A point mass is a body for every m > 0. Levenberg–Marquardt in (m, h), in which loads are linear but for π's last six.
Source: Atkeson 1986 (estimation of inertial parameters of loads).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lagnet.diagnosis.motion.arm.fitting import Errors, fit_values, sensitivities_of
from lagnet.diagnosis.motion.joint.joint_case import JointCase
from lagnet.diagnosis.motion.problem import SLOPES, MotionProblem, motion_rates
from lagnet.recordings.sampling import median_step
from lagnet.rigid_body.inertia import parameters_of_body
from lagnet.rollout.measured_load import measured_load
from lagnet.rollout.one_joint import JointSeries

FARTHEST = 1.0  # [m] |c| of a payload
LEAST_MASS = 1e-4  # [kg]


@dataclass(frozen=True, eq=False)
class BodyLoads:
    """M_ii, load and slope of a last link of unit parameters and no other body, each of shape (10, n, dof)."""

    mass: np.ndarray
    load: np.ndarray
    slope: np.ndarray

    def added(self, series: JointSeries, joint: int, point: np.ndarray) -> JointSeries:
        """The series of a joint with a point mass (m, h), shape (4,), at the last link."""
        body = body_of(point)
        mass, load, slope = (body @ part[:, :, joint] for part in (self.mass, self.load, self.slope))
        return replace(series, mass=series.mass + mass, load=series.load + load, load_slope=series.load_slope + slope)


def body_of(point: np.ndarray) -> np.ndarray:
    """The ten inertial parameters of a point mass (m, h), shape (10,)."""
    return parameters_of_body(float(point[0]), point[1:] / point[0], np.zeros((3, 3)))


def body_loads(problem: MotionProblem) -> BodyLoads:
    """∂/∂π of the load of the last link's body along the measured motion."""
    time, q = problem.series[0].time, np.column_stack([s.q for s in problem.series])
    dof = q.shape[1]
    out = np.zeros((3, 10, *q.shape))
    for run in problem.runs:
        rows = slice(run.first, run.last + 1)
        v, a = motion_rates(time[rows], q[rows])
        stride = max(1, int(SLOPES / median_step(time[rows])))
        for k in range(10):
            bodies = np.zeros((dof, 10))
            bodies[-1, k] = 1.0
            out[:, k, rows] = measured_load(replace(problem.tree, bodies=bodies), q[rows], v, a, stride)
    return BodyLoads(*out)


def sizes_of_point(problem: MotionProblem) -> np.ndarray:
    """Typical (m, h): the mass of the last link or a twentieth of the arm's, at a typical distance of joints."""
    masses = problem.tree.bodies[:, 0]
    mass = max(float(masses[-1]), 0.05 * float(masses.sum()), LEAST_MASS)
    reach = max(0.05, float(np.mean(np.linalg.norm(problem.tree.translations, axis=1))))
    return np.array([mass, *np.full(3, mass * reach)])


def starts_of_point(problem: MotionProblem, sizes: np.ndarray) -> list[np.ndarray]:
    """Masses from a tenth of a typical one to three times it, where the last link's centre is and at its joint."""
    body = problem.tree.bodies[-1]
    centre = body[1:4] / body[0] if body[0] > 0.0 else np.zeros(3)
    places = [centre, centre + 0.3 * sizes[1] / sizes[0]]
    return [np.array([1.0, *c]) * m for m in sizes[0] * np.array([0.1, 0.3, 1.0, 3.0]) for c in places]


def possible(point: np.ndarray) -> np.ndarray:
    """The nearest (m, h) with m > 0 and |c| within `FARTHEST`."""
    mass = max(float(point[0]), LEAST_MASS)
    length = float(np.linalg.norm(point[1:]))
    return np.array([mass, *(point[1:] * min(1.0, FARTHEST * mass / max(length, 1e-300)))])


def joint_errors(cases: dict[int, JointCase], loads: BodyLoads) -> Errors:
    """Errors of each joint's rollouts by its nominal law while the others move as measured."""

    def errors(point: np.ndarray) -> list[np.ndarray]:
        loaded = ((c, replace(c.fit, series=loads.added(c.fit.series, j, point))) for j, c in cases.items())
        return [data.errors(case.law) for case, data in loaded]

    return errors


def fit_point_mass(
    errors: Errors, start: np.ndarray, sizes: np.ndarray, floors: np.ndarray, iterations: int = 20
) -> np.ndarray:
    """(m, h) of the least cost from a start, shape (4,).

    Args:
        errors: of the joints as a function of (m, h).
        start, sizes: shape (4,), of (m, h) [kg, kg m].
        floors: shape (joints,), resolution of the errors [rad].
        iterations: at most, in each round.
    """
    found = sensitivities_of(errors, sizes)
    return fit_values(errors, found, start, sizes, floors, nearest=possible, iterations=iterations)
