"""A payload that searches named beyond the set, and the set of a robot that follows it, too.

New effects of single joints are not followed: on a real arm of hobby servos the names of single motions change, and the
parameters of such a set traded with each other, so that drifts and steps were told where nothing had changed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from lagnet.diagnosis.motion.diagnose import MotionDiagnosis
from lagnet.tracking.servos.tracked import PAYLOAD, TrackedServos, body_of, middle_body
from lagnet.tracking.tracked_set import repeated


@dataclass(frozen=True)
class NewPayload:
    """A payload of the last link that a search named and that the set does not hold: ten inertial parameters."""

    body: tuple[float, ...]


def named_beyond(known: TrackedServos, found: MotionDiagnosis) -> list[NewPayload]:
    """The payload that a search named, unless one is followed already."""
    body = body_of(found)
    return [NewPayload(body)] if body and not known.body else []


def with_new_payload(known: TrackedServos, found: Sequence[Sequence[Mapping[str, Any]]]) -> TrackedServos:
    """The set of a robot with the payload that its recordings show again and again beyond the set of its make.

    Args:
        known: the set of the make.
        found: plain values of `NewPayload`, for each recording of the robot in order of time.

    Returns:
        `known` itself where nothing is to be followed in addition.
    """
    if not repeated([[(PAYLOAD, None) for _ in row] for row in found]):
        return known
    return replace(known, body=middle_body([tuple(map(float, one["body"])) for row in found for one in row]))
