"""Outside the motion it was made for, torque grows no faster than mechanics lets it."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.calling import NotFinite
from lagnet.plausibility.check import Check, Finding
from lagnet.plausibility.search import worst_configuration
from lagnet.plausibility.subject import Subject

NEAR, FAR = 10.0, 100.0  # times the box of motion
# Powers that rigid bodies reach: H is quadratic in the position of sliding joints, c in v, torque linear in a. Turning
# joints come back after a turn; a model that does not know so may still grow with the square.
ALLOWED = {"sliding": 2.0, "turning": 2.0, "v": 2.0, "a": 1.0}


class BoundedGrowth(Check):
    """Exponent of growth between 10 and 100 times the box of motion, of the torque and of ε alone."""

    name = "bounded_growth"
    title = "torque grows no faster than mechanics allows outside the data"
    meaning = "A step outside the data gives torques without bound."
    justification = "Rigid bodies grow with v² and a¹, and with q² where joints slide; 0.1 is the error of an exponent."

    def limit(self, subject: Subject) -> float:
        return 0.1

    def find(self, subject: Subject) -> Finding:
        worst, place, words = -np.inf, {}, ""
        for what, allowed in ALLOWED.items():
            if what == "sliding" and subject.ranges.revolute.all():
                continue
            for part in ("torque", "residual") if subject.offers("residual_torque") else ("torque",):
                try:
                    found, where = worst_configuration(
                        subject, "qva", lambda q, v, a, w=what, p=part: _exponent(subject, w, p, q, v, a)
                    )
                except NotFinite as broken:
                    return Finding(np.inf, broken.where, f"{part} is not finite far outside the data ({what})")
                if found.value - allowed > worst:
                    worst, place = found.value - allowed, where
                    words = f"{part} grows as {what} to the power {found.value:.2f}, {allowed:.0f} allowed; excess"
        return Finding(float(worst), place, words)


def _exponent(subject: Subject, what: str, part: str, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Exponent of the growth of the most growing joint, shape (n,).

    What does not grow is taken off, and both directions count, so that linear and square parts that cancel at one
    place do not look like quick growth from there.
    """
    call = getattr(subject, part)
    rest = call(*_scaled(subject, what, 0.0, q, v, a))
    near, far = (
        np.maximum(*(np.abs(call(*_scaled(subject, what, sign * factor, q, v, a)) - rest) for sign in (1.0, -1.0)))
        / subject.torque_scale
        for factor in (NEAR, FAR)
    )
    # Torques below the typical one far out are no growth, however small they were nearer.
    return (np.log(np.maximum(far, 1.0) / np.maximum(near, 1.0)) / np.log(FAR / NEAR)).max(axis=1)


def _scaled(
    subject: Subject, what: str, factor: float, q: np.ndarray, v: np.ndarray, a: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    if what == "v":
        return q, factor * v, a
    if what == "a":
        return q, v, factor * a
    moved = subject.ranges.revolute if what == "turning" else ~subject.ranges.revolute
    return np.where(moved, factor * q, q), v, a
