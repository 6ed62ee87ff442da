"""Turning the whole arm about a vertical first axis changes nothing."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.check import Check, Finding, NotApplicable
from lagnet.plausibility.search import worst_configuration
from lagnet.plausibility.subject import Subject

HELD = "gravity"  # what gravity asks of the base joint itself
APART = 0.37  # of the joint's range between the two angles compared; no simple fraction, so that no symmetry hides


class BaseAngleIndependence(Check):
    """Offered, not forced: made only where the user says that the first axis is vertical (`vertical_base`).

    A description made of bodies cannot miss it; a learned model that was not built with the symmetry always does, by
    what its training left, so that only its user can say whether that matters.
    """

    name = "base_angle_independence"
    title = "the angle of a vertical first axis does not matter"
    meaning = "Gravity and inertia look the same from every side; a model that sees a difference has learned noise."
    justification = (
        "Exact for an upright arm; a model that was not built so but learned it needs a limit of its user's own."
    )

    def limit(self, subject: Subject) -> float:
        return subject.at_least_rounding(1e-7)

    def find(self, subject: Subject) -> Finding:
        if subject.ranges.joint_types[0] == "prismatic":
            raise NotApplicable("the first joint does not turn")
        if not subject.settings.vertical_base:
            raise NotApplicable(
                "not asked for; if the first axis is vertical, ask with vertical_base (--vertical-base)"
            )

        def missed(q: np.ndarray, v: np.ndarray) -> np.ndarray:
            return np.max(list(_changes(subject, q, v).values()), axis=0)

        worst, where = worst_configuration(subject, "qv", missed)
        found = _changes(subject, np.array([where["q"]]), np.array([where["v"]]))
        what = max(found, key=lambda name: found[name][0])
        turns = f"the angle of {subject.joints[0]} changes {what}, as a share of its typical size"
        holds = f"gravity turns {subject.joints[0]}, as a share of its typical torque"
        return Finding(worst.value, where, holds if what == HELD else turns)


def _changes(subject: Subject, q: np.ndarray, v: np.ndarray) -> dict[str, np.ndarray]:
    """How much turning the base changes each part of the torque, and what gravity asks of the base, each (n,)."""
    low, width = subject.ranges.lower[0], subject.ranges.upper[0] - subject.ranges.lower[0]
    turned = q.copy()
    turned[:, 0] = low + (q[:, 0] - low + APART * width) % width
    inertia = np.sqrt(np.outer(subject.inertia_scale, subject.inertia_scale))
    H = np.abs((subject.mass_matrix(turned) - subject.mass_matrix(q)) / inertia).max(axis=(1, 2))
    c = np.abs((subject.coriolis_torque(turned, v) - subject.coriolis_torque(q, v)) / subject.torque_scale)
    before = subject.gravity_torque(q)
    g = np.abs((subject.gravity_torque(turned) - before) / subject.torque_scale)
    held = np.abs(before[:, 0] / subject.torque_scale[0])
    return {"H": H, "c": c.max(axis=1), "g": g.max(axis=1), HELD: held}
