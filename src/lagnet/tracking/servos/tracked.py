"""The servo laws that are followed over time where recordings hold commands and no torque."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from lagnet.diagnosis.motion.diagnose import MotionDiagnosis
from lagnet.diagnosis.motion.joint.joint_case import sizes_of
from lagnet.diagnosis.motion.joint.joint_diagnosis import JointDiagnosis
from lagnet.diagnosis.motion.joint.refitting import disjoint, groups_of
from lagnet.diagnosis.motion.problem import median_voltage
from lagnet.errors import LagnetError
from lagnet.servos.parameters import NAMES
from lagnet.tracking.tracked_set import SHARE, UNUSUAL, TrackedSet, common_set, set_from_plain

Group = tuple[str, ...]
PAYLOAD = "payload"  # the name of a body on the last link in verdicts
STILL = 1e-6  # [rad or m] resolution where a joint does not move


@dataclass(frozen=True)
class TrackedServo:
    """What is fitted at one joint.

    Args:
        law: parameters of the servo from which a fit starts, in the order of `LAW`.
        effects: names of the effects whose parameters are free; with them those of a servo that no file gives.
        free: law parameters that are fitted, those of a group with one value.
        sizes: typical size of every parameter, in the order of `LAW`; empty for a joint that did not move.
        scale_is_set: whether loads determine the scale of torques; else torques are followed as ratios to kp.
    """

    law: tuple[float, ...]
    effects: tuple[str, ...] = ()
    free: tuple[Group, ...] = ()
    sizes: tuple[float, ...] = ()
    scale_is_set: bool = True


@dataclass(frozen=True)
class Added:
    """An effect of one joint that the set holds beyond that of its make, with the law parameters that it set free."""

    joint: int
    effect: str
    groups: tuple[Group, ...]


@dataclass(frozen=True)
class TrackedServos:
    """What is fitted to each recording of a make or robot that has commands and no torque.

    Args:
        servos: one a joint.
        floors: resolution of the positions [rad or m].
        left: for each joint, error of rollouts where the set was found, root mean square [rad or m]; empty: not known.
        body: ten inertial parameters of a payload of the last link, whose share is followed; empty: none.
        voltage: of the supply, to which the laws belong [V]; 0: not recorded.
        added: effects beyond the set of the make; a fit tells how well its recording determines them.
    """

    servos: tuple[TrackedServo, ...]
    floors: tuple[float, ...]
    left: tuple[float, ...] = ()
    body: tuple[float, ...] = ()
    voltage: float = 0.0
    added: tuple[Added, ...] = ()

    def is_unusual(self, left: np.ndarray) -> bool:
        """Whether errors are clearly larger than where the set was found, at any joint; True if it is not known."""
        return not self.left or bool(np.any(left > UNUSUAL * np.array(self.left)))

    @property
    def laws(self) -> np.ndarray:
        """Where a fit starts, shape (dof, len(LAW))."""
        return np.array([s.law for s in self.servos])

    def plain(self) -> dict[str, Any]:
        """Plain values, for files and checksums."""
        return asdict(self)


def servos_from_plain(plain: Mapping[str, Any]) -> TrackedServos:
    """Inverse of `TrackedServos.plain` after a way through JSON."""
    servos = tuple(
        TrackedServo(
            tuple(map(float, s["law"])),
            tuple(map(str, s["effects"])),
            _groups(s["free"]),
            tuple(map(float, s["sizes"])),
            bool(s["scale_is_set"]),
        )
        for s in plain["servos"]
    )
    numbers = {name: tuple(map(float, plain[name])) for name in ("floors", "left", "body")}
    added = tuple(Added(int(a["joint"]), str(a["effect"]), _groups(a["groups"])) for a in plain["added"])
    return TrackedServos(servos, **numbers, voltage=float(plain["voltage"]), added=added)


def _groups(plain: Sequence[Sequence[str]]) -> tuple[Group, ...]:
    return tuple(tuple(map(str, group)) for group in plain)


def servos_of_calibration(found: MotionDiagnosis) -> TrackedServos:
    """The laws and the payload that a calibration named; what they leave is not yet known."""
    servos = tuple(_servo(d, found.corrected.laws[j]) for j, d in enumerate(found.joints))
    floors = tuple(STILL if d is None else d.case.floor for d in found.joints)
    return TrackedServos(servos, floors, body=body_of(found), voltage=median_voltage(found.fit_recordings))


def body_of(found: MotionDiagnosis) -> tuple[float, ...]:
    """Ten inertial parameters of the payload that a diagnosis found; empty: none."""
    last, nominal = (m.nominal.inertial_parameters()[-1] for m in (found.corrected, found.nominal))
    return tuple(map(float, last - nominal)) if np.any(last != nominal) else ()


def middle_body(bodies: Sequence[tuple[float, ...]]) -> tuple[float, ...]:
    """The body whose mass lies in the middle: medians of mass and centre by themselves need not go together."""
    return sorted(bodies)[len(bodies) // 2]


def _servo(found: JointDiagnosis | None, law: np.ndarray) -> TrackedServo:
    if found is None:
        return TrackedServo(tuple(map(float, law)))
    case = found.case
    sizes = sizes_of(case.scales)
    kept = tuple(g for g in groups_of(case, found.named.effects) if case.scale_is_set or g[0] != "kp")
    return TrackedServo(
        tuple(map(float, found.named_law)),
        found.named.effects,
        kept,
        tuple(float(sizes[n]) for n in NAMES),
        case.scale_is_set,
    )


def common_servos(sets: Sequence[TrackedServos]) -> TrackedServos:
    """At each joint what at least half of the robots of a make show, from the median of their laws."""
    servos = tuple(_common([s.servos[j] for s in sets]) for j in range(len(sets[0].servos)))
    floors, left = (tuple(map(float, np.median([getattr(s, n) for s in sets], axis=0))) for n in ("floors", "left"))
    loaded = [s.body for s in sets if s.body]
    body = middle_body(loaded) if loaded and len(loaded) >= SHARE * len(sets) else ()
    return TrackedServos(servos, floors, left, body, float(np.median([s.voltage for s in sets])))


def _common(servos: Sequence[TrackedServo]) -> TrackedServo:
    moved = [s for s in servos if s.sizes] or list(servos)
    counts = Counter(g for s in moved for g in s.free)
    free = tuple(disjoint([g for g, n in counts.items() if n >= SHARE * len(moved)]))
    names = Counter(e for s in moved for e in s.effects)
    law, sizes = (np.median([getattr(s, n) for s in moved], axis=0) for n in ("law", "sizes"))
    kept = tuple(e for e, n in names.items() if n >= SHARE * len(moved))
    plain_law, plain_sizes = (tuple(map(float, x)) for x in (law, sizes))
    return replace(moved[0], law=plain_law, effects=kept, free=free, sizes=plain_sizes)


Followed = TrackedSet | TrackedServos


def followed_from_plain(plain: Mapping[str, Any]) -> Followed:
    """Inverse of `plain` of either set."""
    return servos_from_plain(plain) if "servos" in plain else set_from_plain(plain)


def common_followed(sets: Sequence[Followed], make: str) -> Followed:
    """What at least half of the robots of a make show.

    Raises:
        LagnetError: some have torque, some commands alone.
    """
    servos = [s for s in sets if isinstance(s, TrackedServos)]
    torques = [s for s in sets if isinstance(s, TrackedSet)]
    if servos and torques:
        step = "state calibration recordings, or two makes"
        raise LagnetError("some robots log torque, some commands alone", where=f"make {make}", next_step=step)
    return common_servos(servos) if servos else common_set(torques)
