"""Outside the motion it was made for, torque grows no faster than mechanics lets it."""

from __future__ import annotations

import numpy as np

from lagnet.plausibility.calling import NotFinite
from lagnet.plausibility.check import Check, Finding
from lagnet.plausibility.search import Space, Worst, starting_points, worst_configuration
from lagnet.plausibility.subject import Subject

NEAR, FAR = 100.0, 1000.0  # times the box of motion: far beyond where a network bends
# Powers that rigid bodies reach: H is quadratic in the position of sliding joints, c in v, torque linear in a. Turning
# joints come back after a turn; a model that does not know so may still grow with the square.
ALLOWED = {"sliding": 2.0, "turning": 2.0, "v": 2.0, "a": 1.0}


class BoundedGrowth(Check):
    """Exponent of growth between 100 and 1000 times the box of motion, of the torque and of ε alone."""

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
                    found, where = _worst(subject, what, part)
                except NotFinite as broken:
                    return Finding(np.inf, broken.where, f"{part} is not finite far outside the data ({what})")
                if found.value - allowed > worst:
                    worst, place = found.value - allowed, where
                    words = f"{part} grows as {what} to the power {found.value:.2f}, {allowed:.0f} allowed; excess"
        return Finding(float(worst), place, words)


def _worst(subject: Subject, what: str, part: str) -> tuple[Worst, dict[str, list[float]]]:
    """Where the exponent of a joint's growth is largest.

    What lies far out is measured against the largest of what lies near, anywhere in the box: at a single place, parts
    that cancel there would make any growth from there look quick.
    """
    space = Space(subject, "qva")
    everywhere = space.decode(starting_points(subject, space.dimension))
    largest = _size(subject, what, part, NEAR, *everywhere).max(axis=0)

    def exponent(q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
        near, far = (_size(subject, what, part, factor, q, v, a) for factor in (NEAR, FAR))
        # Torques below the typical one far out are no growth, however small they were nearer.
        ratio = np.maximum(far, 1.0) / np.maximum(np.maximum(near, largest), 1.0)
        return (np.log(ratio) / np.log(FAR / NEAR)).max(axis=1)

    return worst_configuration(subject, "qva", exponent)


def _size(
    subject: Subject, what: str, part: str, factor: float, q: np.ndarray, v: np.ndarray, a: np.ndarray
) -> np.ndarray:
    """What a part of the torque gains in either direction, over the typical torque, shape (n, dof)."""
    call = getattr(subject, part)
    rest = call(*_scaled(subject, what, 0.0, q, v, a))
    there, back = (np.abs(call(*_scaled(subject, what, sign * factor, q, v, a)) - rest) for sign in (1.0, -1.0))
    return np.maximum(there, back) / subject.torque_scale


def _scaled(
    subject: Subject, what: str, factor: float, q: np.ndarray, v: np.ndarray, a: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    if what == "v":
        return q, factor * v, a
    if what == "a":
        return q, v, factor * a
    moved = subject.ranges.revolute if what == "turning" else ~subject.ranges.revolute
    return np.where(moved, factor * q, q), v, a
