"""The identified layer of a corrected model in the terms of a simulator: what named effects would add the same torque.

Changed bodies and weights of viscous and dry friction, rotor, offset, load friction, spring and gain act as the effects
of those names do. Curves over speed and position, bristles, lag and ties between joints have no such effect, and what
would make a damping, a friction or a rotor negative is no arm that moves forward.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.identified import IdentifiedLayer
from lagnet.models.corrected.motion_terms import MotionTerm
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.rigid_body.inertia import smallest_eigenvalue
from lagnet.rigid_body.robot import Robot

NO_LAW = "no law of a simulator adds this torque"
NEGATIVE = "the sum with what is named would be below zero, which no simulator moves forward"
NO_BODY = "the changed bodies would be no bodies of matter, which simulators refuse"
ALIKE: dict[str, tuple[str, Callable[[float], dict[str, float]]]] = {
    "viscous": ("viscous_friction", lambda w: {"Fv": w}),
    "dry": ("coulomb_friction", lambda w: {"Fc": w}),
    "offset": ("torque_offset", lambda w: {"b": w}),
    "rotor": ("rotor_inertia", lambda w: {"Ia": w}),
    "load": ("load_dependent_friction", lambda w: {"K": w}),
    "spring": ("joint_spring", lambda w: {"k": w, "q0": 0.0}),
    "gain": ("torque_gain", lambda w: {"g": 1.0 + w}),
}


@dataclass(frozen=True, eq=False)
class IdentifiedPart:
    """One part of an identified layer.

    Args:
        kind: 'bodies', or a kind of `lagnet.models.corrected.motion_terms`.
        joint: index of the joint, or of the one before the link.
        values: its numbers by name.
        alike: the named effect that adds the same torque; None where there is none.
        reason: why there is none, else "".
    """

    kind: str
    joint: int
    values: dict[str, Any]
    alike: NamedEffect | None
    reason: str = ""


def changed_robot(robot: Robot, layer: IdentifiedLayer) -> tuple[Robot, list[IdentifiedPart]]:
    """The robot with the identified bodies, and a part for every link that changes."""
    if layer.bodies is None or not layer.bodies.any():
        return robot, []
    links = np.flatnonzero(layer.bodies.any(axis=1))
    parameters = robot.inertial_parameters() + layer.bodies
    real = bool(np.all(smallest_eigenvalue(parameters[links]) > 0.0))
    parts = []
    for j in links.tolist():
        values = {"change": [float(x) for x in layer.bodies[j]]}
        alike = NamedEffect("link_inertia", j, _named_body(layer.bodies[j])) if real else None
        parts.append(IdentifiedPart("bodies", j, values, alike, "" if real else NO_BODY))
    return (robot.with_inertial_parameters(parameters) if real else robot), parts


def _named_body(change: np.ndarray) -> dict[str, float]:
    names = [p.name for p in effect_named("link_inertia").free_parameters]
    return dict(zip(names, (float(x) for x in change), strict=True))


def term_part(term: MotionTerm, weight: float, least: float) -> IdentifiedPart:
    """What a term becomes.

    Args:
        term: the function of motion.
        weight: its weight.
        least: smallest weight with which the sum stays above zero; −inf where any will do.
    """
    values = {"weight": weight, "scale": term.scale}
    if term.kind not in ALIKE:
        return IdentifiedPart(term.kind, term.joint, values, None, NO_LAW)
    if weight < least:
        return IdentifiedPart(term.kind, term.joint, values, None, NEGATIVE)
    name, named = ALIKE[term.kind]
    return IdentifiedPart(term.kind, term.joint, values, NamedEffect(name, term.joint, named(weight)))
