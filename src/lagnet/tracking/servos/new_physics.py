"""Servo effects that a search named beyond the set, and the set of a robot that follows them, too."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from lagnet.diagnosis.motion.diagnose import MotionDiagnosis
from lagnet.diagnosis.motion.joint.refitting import disjoint
from lagnet.servos.catalogue import servo_effect
from lagnet.tracking.servos.tracked import PAYLOAD, TrackedServo, TrackedServos, body_of
from lagnet.tracking.statistics.followed_law import stage_of
from lagnet.tracking.tracked_set import repeated


@dataclass(frozen=True)
class NewServoEffect:
    """An effect that a search named and that the set does not hold.

    Args:
        effect: name in the catalogue of servos, or a payload.
        joint: index of the joint; None: the whole arm.
        values: its parameters by name, SI units; of a payload none.
        body: of a payload, its ten inertial parameters.
    """

    effect: str
    joint: int | None
    values: Mapping[str, float]
    body: tuple[float, ...] = ()


def named_beyond(known: TrackedServos, found: MotionDiagnosis) -> list[NewServoEffect]:
    """What a search named that is neither followed already nor another name of what is."""
    body = body_of(found)
    carried = [NewServoEffect(PAYLOAD, None, {}, body)] if body and not known.body else []
    return carried + [
        NewServoEffect(name, joint, servo_effect(name).read(diagnosis.named_law))
        for joint, (servo, diagnosis) in enumerate(zip(known.servos, found.joints, strict=True))
        if diagnosis is not None and servo.sizes
        for name in diagnosis.named.effects
        if not any(_alike(name, followed) for followed in servo.effects)
    ]


def _alike(one: str, other: str) -> bool:
    """Whether two names stand for one thing near the limit of what a recording shows: all friction is alike there."""
    held = one in servo_effect(other).contains or other in servo_effect(one).contains
    return one == other or held or stage_of(one) == stage_of(other) == "torque"


def with_new_servo_effects(known: TrackedServos, found: Sequence[Sequence[Mapping[str, Any]]]) -> TrackedServos:
    """The set of a robot with what its recordings show again and again beyond the set of its make.

    Args:
        known: the set of the make.
        found: plain values of `NewServoEffect`, for each recording of the robot in order of time.

    Returns:
        `known` itself where nothing is to be followed in addition.
    """
    rows = [{(str(e["effect"]), e["joint"]): e for e in effects} for effects in found]
    servos, body = list(known.servos), known.body
    for effect, joint in repeated([list(row) for row in rows]):
        named = [row[effect, joint] for row in rows if (effect, joint) in row]
        if joint is None:
            body = _middle([tuple(map(float, e["body"])) for e in named])
        else:
            servos[joint] = _with(servos[joint], effect, [e["values"] for e in named])
    larger = replace(known, servos=tuple(servos), body=body)
    return known if larger == known else larger


def _middle(bodies: Sequence[tuple[float, ...]]) -> tuple[float, ...]:
    """The body whose mass lies in the middle: medians of mass and centre by themselves need not go together."""
    return sorted(bodies)[len(bodies) // 2]


def _with(servo: TrackedServo, effect: str, values: Sequence[Mapping[str, float]]) -> TrackedServo:
    law = servo_effect(effect)
    middle = {p.name: float(np.median([v[p.name] for v in values])) for p in law.parameters}
    groups = disjoint([*servo.free, *law.frees, *((extra,) for extra in law.with_it)])
    return replace(
        servo,
        law=tuple(map(float, law.apply(np.array(servo.law), middle))),
        effects=(*servo.effects, effect),
        free=tuple(g for g in groups if servo.scale_is_set or g[0] != "kp"),
    )
