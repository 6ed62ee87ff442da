"""A full turn of a revolute joint leads back to the same physics, and does no work."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.check import Check, Finding, NotApplicable
from lagnet.plausibility.search import worst_configuration
from lagnet.plausibility.subject import Subject

ROUND = 64  # points of a turn; the mean of a trigonometric polynomial of degree below 64 is exact


class PeriodicJoints(Check):
    """Shifts each revolute joint by 2π, and averages its gravity torque over the turn.

    The work of a turn needs no search: it is the same wherever the other joints are, if gravity torque is a gradient
    and periodic.
    """

    name = "periodic_joints"
    title = "revolute joints are periodic"
    meaning = "After a full turn the arm is where it was, so that its torque must be, too."
    justification = "Exact for rigid bodies; 1e-7 leaves room for the rounding of sin(q + 2π)."

    def limit(self, subject: Subject) -> float:
        return subject.at_least_rounding(1e-7)

    def find(self, subject: Subject) -> Finding:
        turning = [int(j) for j in np.flatnonzero(subject.ranges.revolute)]
        if not turning:
            raise NotApplicable("the model has no revolute joint")

        def missed(q: np.ndarray, v: np.ndarray) -> np.ndarray:
            return np.max([self._shift(subject, q, v, j) for j in turning], axis=0)

        worst, where = worst_configuration(subject, "qv", missed)
        q, v = np.array([where["q"]]), np.array([where["v"]])
        joint = turning[int(np.argmax([self._shift(subject, q, v, j)[0] for j in turning]))]
        value, detail = worst.value, f"a full turn of {subject.joints[joint]} changes H, c or g"
        pumped, which, at = self._work(subject, turning)
        if pumped > value:
            value, detail = pumped, f"gravity torque of {subject.joints[which]} does work over a full turn"
            where = {"joint": subject.joints[which], "q": at}
        return Finding(value, where, detail)

    @staticmethod
    def _shift(subject: Subject, q: np.ndarray, v: np.ndarray, joint: int) -> np.ndarray:
        turned = q.copy()
        turned[:, joint] += 2 * np.pi
        both, n = np.concatenate([q, turned]), len(q)
        scale = np.sqrt(np.outer(subject.inertia_scale, subject.inertia_scale))
        H, c = subject.mass_matrix(both), subject.coriolis_torque(both, np.tile(v, (2, 1)))
        g = subject.gravity_torque(both)
        return np.max(
            [
                np.abs((H[n:] - H[:n]) / scale).max(axis=(1, 2)),
                np.abs((c[n:] - c[:n]) / subject.torque_scale).max(axis=1),
                np.abs((g[n:] - g[:n]) / subject.torque_scale).max(axis=1),
            ],
            axis=0,
        )

    @staticmethod
    def _work(subject: Subject, turning: list[int]) -> tuple[float, int, list[float]]:
        """Mean gravity torque of a joint over its own turn, others held at random places; the worst joint and place."""
        rest, _, _ = subject.random(8, salt=5)
        found = []
        for joint in turning:
            q = np.repeat(rest, ROUND, axis=0)
            q[:, joint] = np.tile(2 * np.pi * np.arange(ROUND) / ROUND, len(rest))
            mean = subject.gravity_torque(q)[:, joint].reshape(len(rest), ROUND).mean(axis=1)
            found.append(np.abs(mean) / subject.torque_scale[joint])
        worst, place = (int(k) for k in np.unravel_index(np.argmax(found), np.shape(found)))
        return float(found[worst][place]), turning[worst], rest[place].tolist()
