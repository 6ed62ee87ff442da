"""What searches named beyond the set of a make where commands alone were recorded, and sets that hold it, too."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from lagnet.diagnosis.motion.diagnose import MotionDiagnosis
from lagnet.diagnosis.motion.joint.refitting import disjoint
from lagnet.diagnosis.motion.wording import RATIOS
from lagnet.servos.catalogue import servo_effect
from lagnet.servos.parameters import INDEX, KP
from lagnet.tracking.servos.tracked import PAYLOAD, Added, TrackedServo, TrackedServos, body_of, middle_body
from lagnet.tracking.statistics.followed_law import stage_of
from lagnet.tracking.tracked_set import repeated

Found = Sequence[Sequence[Mapping[str, Any]]]  # plain values of `NewServoEffect`, for each recording in order of time


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


@dataclass(frozen=True, eq=False)
class Candidate:
    """A new effect of one joint that may be followed.

    Args:
        joint, effect: what it is.
        values: its parameters by name, the medians of what the searches found.
        named: indices of the recordings whose searches named it.
        absent: law of the joint in the set, which does not hold it.
    """

    joint: int
    effect: str
    values: Mapping[str, float]
    named: tuple[int, ...]
    absent: tuple[float, ...]


def named_beyond(known: TrackedServos, found: MotionDiagnosis) -> list[NewServoEffect]:
    """What a search named that is neither followed already nor another name of what is."""
    body = body_of(found)
    carried = [NewServoEffect(PAYLOAD, None, {}, body)] if body and not known.body else []
    return carried + [
        NewServoEffect(name, joint, _values(name, diagnosis.named_law, servo))
        for joint, (servo, diagnosis) in enumerate(zip(known.servos, found.joints, strict=True))
        if diagnosis is not None and servo.sizes
        for name in diagnosis.named.effects
        if not any(_alike(name, followed) for followed in servo.effects)
    ]


def _values(effect: str, law: np.ndarray, servo: TrackedServo) -> dict[str, float]:
    """What a search found, on the set's scale of torques where no load sets it."""
    scale = 1.0 if servo.scale_is_set else servo.law[KP] / float(law[KP])
    torques = {p.name for p in servo_effect(effect).parameters if p.unit in RATIOS}
    return {n: v * (scale if n in torques else 1.0) for n, v in servo_effect(effect).read(law).items()}


def _alike(one: str, other: str) -> bool:
    """Whether two names stand for one thing near the limit of what a recording shows: all friction is alike there."""
    held = one in servo_effect(other).contains or other in servo_effect(one).contains
    return one == other or held or stage_of(one) == stage_of(other) == "torque"


def with_new_payload(known: TrackedServos, found: Found) -> TrackedServos:
    """The set of a robot with the payload that its recordings show again and again beyond the set of its make.

    Returns:
        `known` itself where none is to be followed in addition.
    """
    bodies = [[one["body"] for one in row if one["effect"] == PAYLOAD] for row in found]
    if known.body or not repeated([[(PAYLOAD, None) for _ in row] for row in bodies]):
        return known
    return replace(known, body=middle_body([tuple(map(float, body)) for row in bodies for body in row]))


def candidates_of(known: TrackedServos, found: Found) -> list[Candidate]:
    """Every effect of a joint that a search named, the most frequent first."""
    named: dict[tuple[int, str], dict[int, Mapping[str, float]]] = defaultdict(dict)
    for at, row in enumerate(found):
        for one in row:
            if one["effect"] != PAYLOAD:
                named[int(one["joint"]), str(one["effect"])][at] = one["values"]
    out = [
        Candidate(joint, effect, _middle(list(v.values())), tuple(v), known.servos[joint].law)
        for (joint, effect), v in named.items()
    ]
    return sorted(out, key=lambda c: (-len(c.named), c.joint, c.effect))


def again_and_again(candidates: Sequence[Candidate], recordings: int) -> list[Candidate]:
    """Those that are named often enough at their joint, see `repeated`."""
    kept = []
    for joint in sorted({c.joint for c in candidates}):
        there = [c for c in candidates if c.joint == joint]
        rows = [[(c.effect, joint) for c in there if at in c.named] for at in range(recordings)]
        kept += [c for c in there if (c.effect, joint) in repeated(rows)]
    return kept


def _middle(values: Sequence[Mapping[str, float]]) -> dict[str, float]:
    return {name: float(np.median([v[name] for v in values])) for name in values[0]}


def with_candidates(known: TrackedServos, candidates: Sequence[Candidate]) -> TrackedServos:
    """The set with further effects; one that is another name of what is followed sets nothing free."""
    for one in candidates:
        before = known.servos[one.joint]
        alike = any(_alike(one.effect, followed) for followed in before.effects)
        servo = before if alike else _with(before, one)
        new = tuple(g for g in servo.free if g not in before.free)
        servos = tuple(servo if j == one.joint else s for j, s in enumerate(known.servos))
        known = replace(known, servos=servos, added=(*known.added, Added(one.joint, one.effect, new)))
    return known


def _with(servo: TrackedServo, one: Candidate) -> TrackedServo:
    law = servo_effect(one.effect)
    groups = disjoint([*servo.free, *law.frees, *((extra,) for extra in law.with_it)])
    free = tuple(g for g in groups if servo.scale_is_set or g[0] != "kp")
    changed = law.apply(np.array(servo.law), one.values)
    for group in set(groups) - set(free):
        changed[[INDEX[name] for name in group]] = np.array(servo.law)[[INDEX[name] for name in group]]
    return replace(servo, law=tuple(map(float, changed)), effects=(*servo.effects, one.effect), free=free)
