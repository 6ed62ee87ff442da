"""Steady torque of the identified layer at one joint: friction over speed, torque and friction over position."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lagnet.diagnosis.identified.fit import Identified
from lagnet.models.corrected.motion_terms import BENDS, OVER_POSITION, MotionTerm, bend, wave

SPEEDS = 20  # points of a friction curve in each direction, closer near rest, where it bends; rest itself is a jump
POSITIONS = 41  # points over the range of a joint
USUAL = 0.5  # of the usual largest speed, at which friction over position is told


def friction_curve(found: Identified, joint: int) -> dict[str, list[float]]:
    """Steady friction beside the named one over speed, without load, on the average over the joint's range [N m]."""
    top = _top_speed(found, joint)
    ahead = top * (np.arange(1, SPEEDS + 1) / SPEEDS) ** 2
    speed = np.concatenate([-ahead[::-1], ahead])
    return {"speed": speed.tolist(), "torque": _friction(found, joint, speed).tolist()}


def curve_over_position(found: Identified, joint: int) -> dict[str, list[float] | float] | None:
    """Torque beside the named one that depends on position, and friction at a usual speed [N m]; None without."""
    own = [(term, weight) for term, weight in _own(found, joint) if term.kind in OVER_POSITION]
    if not own:
        return None
    centre, scale = own[0][0].centre, own[0][0].scale
    position, speed = centre + scale * np.linspace(-1.0, 1.0, POSITIONS), USUAL * _top_speed(found, joint)
    offsets = [weight for term, weight in _own(found, joint) if term.kind == "offset"]
    torque = np.full(POSITIONS, float(sum(offsets)))
    friction = np.full(POSITIONS, float(_friction(found, joint, np.array([speed]))[0]))
    for term, weight in own:
        what, order = OVER_POSITION[term.kind]
        shape = weight * wave(order, position, centre, scale)
        if what == "position":
            torque += shape
        else:
            friction += shape * (speed if what == "viscous_path" else 1.0)
    return {"position": position.tolist(), "torque": torque.tolist(), "friction": friction.tolist(), "at_speed": speed}


def _own(found: Identified, joint: int) -> Iterator[tuple[MotionTerm, float]]:
    """Functions of one joint's own motion, with their weights."""
    pairs = zip(found.layer.terms, found.layer.weights.tolist(), strict=True)
    return ((t, w) for t, w in pairs if t.joint == joint and t.other is None)


def _top_speed(found: Identified, joint: int) -> float:
    """Usual largest speed of a joint [rad/s]; 1 where no curve over speed is known."""
    return max((t.scale for t, _ in _own(found, joint) if t.kind in BENDS), default=1.0)


def _friction(found: Identified, joint: int, speed: np.ndarray) -> np.ndarray:
    """Steady friction over speed, on the average over the joint's range."""
    sign, torque = np.sign(speed), np.zeros(speed.size)
    for term, weight in _own(found, joint):
        if term.kind in BENDS:
            torque = torque + weight * bend(BENDS[term.kind], speed / term.scale, sign)
        elif term.kind in ("viscous", "dry"):
            torque = torque + weight * (speed if term.kind == "viscous" else sign)
    return torque
