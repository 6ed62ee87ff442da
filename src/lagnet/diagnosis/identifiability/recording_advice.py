"""The motion in which two tied laws differ, in words: what to record next."""

from __future__ import annotations

from collections.abc import Iterable

from lagnet.diagnosis.identifiability.equivalent_laws import observationally_equivalent
from lagnet.effects.catalogue import effect_named

NEVER = (
    "no motion tells the two apart, for they are equal at every speed; read the torque at rest with the brake on "
    "and the joint unloaded: an offset is still there, friction is not"
)
GEAR = (
    "strokes in both directions under several loads; beside friction per load no motion tells a gain from friction "
    "that differs by whether motor or load drives: hold the joint with a stop and read a known torque, a gain is "
    "still there"
)

RECORDINGS: dict[frozenset[str], str] = {
    frozenset(pair): words
    for *pair, words in (
        (
            "coulomb_friction",
            "load_dependent_friction",
            "strokes in both directions in poses in which gravity loads the joint very differently",
        ),
        ("asymmetric_friction", "coulomb_friction", NEVER),
        ("asymmetric_friction", "torque_offset", NEVER),
        ("viscous_friction", "time_delay", "fast strokes about several poses: a delay follows the change of torque"),
        ("viscous_friction", "quadratic_drag", "strokes at constant speed, from slow to the fastest allowed"),
        ("viscous_friction", "coulomb_friction", "strokes at constant speed, from slow to the fastest allowed"),
        ("coulomb_friction", "quadratic_drag", "strokes at constant speed, from slow to the fastest allowed"),
        ("coulomb_friction", "stribeck_friction", "slow passes through zero speed beside fast ones"),
        ("coulomb_friction", "presliding_hysteresis", "small, slow strokes back and forth beside wide ones"),
        (
            "stribeck_friction",
            "presliding_hysteresis",
            "reversals of small strokes beside slow passes in one direction",
        ),
        ("stribeck_friction", "backlash", "slow reversals in poses in which the load does not change sign"),
        ("presliding_hysteresis", "backlash", "slow reversals in poses in which the load does not change sign"),
        ("torque_gain", "torque_offset", "poses in which gravity loads the joint very differently, in both senses"),
        ("torque_gain", "load_dependent_friction", GEAR),
        ("torque_gain", "payload", "the wrist in several orientations, at rest and accelerated"),
        ("torque_gain", "rotor_inertia", "poses that gravity loads differently, and strong accelerations in each"),
        ("torque_gain", "saturation", "torque from low to as high as allowed"),
        ("rotor_inertia", "payload", "other joints accelerated in several poses: a rotor feels its own joint alone"),
        (
            "rotor_inertia",
            "link_inertia",
            "other joints accelerated in several poses: a rotor feels its own joint alone",
        ),
        ("gravity_tilt", "payload", "the wrist in several orientations, with the arm stretched and folded"),
        (
            "gravity_tilt",
            "encoder_offset",
            "gravity-loaded poses over a wide range of every joint, one after the other",
        ),
        ("joint_spring", "torque_offset", "the widest range of positions of the joint"),
        ("joint_spring", "torque_ripple", "a slow sweep over the widest range of positions of the joint"),
    )
}


def recording_against(first: Iterable[str], second: Iterable[str]) -> str:
    """What to record to distinguish two explanations, both given by the names that they consist of."""
    first, second = tuple(first), tuple(second)
    if observationally_equivalent(first, second):
        return NEVER
    known = [RECORDINGS[pair] for a in first for b in second if (pair := frozenset((a, b))) in RECORDINGS]
    return "; ".join(dict.fromkeys(known or [effect_named(name).shown_by for name in (*first, *second)]))
