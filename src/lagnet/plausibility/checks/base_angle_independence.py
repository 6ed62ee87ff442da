"""Turning the whole arm about a vertical first axis changes nothing."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.check import Check, Finding, NotApplicable
from lagnet.plausibility.search import worst_configuration
from lagnet.plausibility.subject import Subject

SYMMETRIC = 1e-6  # of the torque: a reference that misses less than this is taken to stand upright
APART = 0.37  # of the joint's range between the two angles compared; no simple fraction, so that no symmetry hides


class BaseAngleIndependence(Check):
    """Offered, not forced: asked by the user (`vertical_base`) or shown by the reference."""

    name = "base_angle_independence"
    title = "the angle of a vertical first axis does not matter"
    meaning = "Gravity and inertia look the same from every side; a model that sees a difference has learned noise."
    justification = "Exact for an upright arm; a learned model that was not built so needs a limit of its user's own."

    def limit(self, subject: Subject) -> float:
        return subject.at_least_rounding(1e-7)

    def find(self, subject: Subject) -> Finding:
        if subject.ranges.joint_types[0] == "prismatic":
            raise NotApplicable("the first joint does not turn")
        if not (subject.settings.vertical_base or self._reference_stands_upright(subject)):
            raise NotApplicable(
                "nothing says that the first axis is vertical; ask with vertical_base, or give a reference"
            )

        low, width = subject.ranges.lower[0], subject.ranges.upper[0] - subject.ranges.lower[0]

        def missed(q: np.ndarray, v: np.ndarray) -> np.ndarray:
            turned = q.copy()
            turned[:, 0] = low + (q[:, 0] - low + APART * width) % width
            scale = np.sqrt(np.outer(subject.inertia_scale, subject.inertia_scale))
            H = np.abs((subject.mass_matrix(turned) - subject.mass_matrix(q)) / scale).max(axis=(1, 2))
            c = subject.coriolis_torque(turned, v) - subject.coriolis_torque(q, v)
            g = subject.gravity_torque(turned) - subject.gravity_torque(q)
            held = np.abs(subject.gravity_torque(q)[:, 0] / subject.torque_scale[0])
            others = np.abs(np.concatenate([c, g], axis=1) / np.tile(subject.torque_scale, 2)).max(axis=1)
            return np.max([H, others, held], axis=0)

        worst, where = worst_configuration(subject, "qv", missed)
        detail = f"H, c or g depends on the angle of {subject.joints[0]}, or gravity turns it"
        return Finding(worst.value, where, detail)

    @staticmethod
    def _reference_stands_upright(subject: Subject) -> bool:
        if subject.reference is None:
            return False
        q, _, _ = subject.random(64, salt=6)
        torque = np.asarray(subject.reference.gravity_torque(q), dtype=float)
        turned = q.copy()
        turned[:, 0] += 0.7
        change = np.asarray(subject.reference.gravity_torque(turned), dtype=float) - torque
        return bool(max(np.abs(torque[:, 0]).max(), np.abs(change).max()) <= SYMMETRIC * np.abs(torque).max())
