"""Beside a large cause a small effect is claimed where it explains more than all that is left, and not else."""

from __future__ import annotations

import numpy as np
from tests.diagnosis.conftest import Plant
from tests.diagnosis.posed import pose

from lagnet.diagnosis.rules.negligible_torque import NegligibleTorque, special_case

JOINT = 1
LARGE, SMALL = 30.0, 0.25  # [N m s/rad], [N m]: a sixtieth of the torque
BOTH = ("viscous_friction", "coulomb_friction")


def rejected(arm, real) -> set[str]:
    """What of both effects is too small, where exactly these are fitted."""
    posed = pose(arm, real.record(1), real.record(2))
    candidate = posed.candidate(posed.select({JOINT: BOTH}))
    sizes = NegligibleTorque.sizes(candidate.problem, candidate.effects)
    assert dict(zip((e.effect for e in candidate.effects), np.array(sizes) > 1.0, strict=True)) == {
        "viscous_friction": True,
        "coulomb_friction": False,
    }  # against the mismatch alone
    return {r.effect for r in NegligibleTorque().rejected(candidate)}


def law(v):
    return LARGE * v + SMALL * np.tanh(v / 1e-3)


def test_it_stays_where_it_explains_more_than_what_is_left(plant, arm, at) -> None:
    assert rejected(arm, plant(at(JOINT, lambda q, v, a, t: law(v)))) == set()


def test_it_goes_where_more_is_left(plant, arm, at) -> None:
    real = plant(at(JOINT, lambda q, v, a, t: law(v) + 4.0 * SMALL * np.sin(11.0 * q)))
    assert rejected(arm, real) == {"coulomb_friction"}


def found_alone(arm, effect: str, law) -> tuple[set[str], tuple[str, ...]]:
    """What is rejected of one effect, and what the search takes, where noise is a thousandth of a small torque."""
    real = Plant(arm, (law,), noise=1e-5, encoder=0.0)
    posed = pose(arm, real.record(1), real.record(2))
    candidate = posed.candidate(posed.select({JOINT: (effect,)}))
    searched = posed.search().local[JOINT]
    return (
        {r.effect for r in NegligibleTorque().rejected(candidate)},
        tuple(posed.library.hypotheses[i].effect for i in searched),
    )


def test_however_small_it_stays_where_next_to_nothing_else_is_left(arm, at) -> None:
    share = 0.001  # of the torque: less than is claimed beside anything that it could stand for
    small = share * Plant(arm).usual_torque()[JOINT]
    drag = at(JOINT, lambda q, v, a, t: small * np.tanh(v / 1e-3))
    assert found_alone(arm, "coulomb_friction", drag) == (set(), ("coulomb_friction",))
    gain = at(JOINT, lambda q, v, a, t: share * t)  # as a link that is a little heavier would have it
    assert found_alone(arm, "torque_gain", gain) == ({"torque_gain"}, ())


def test_an_offset_takes_the_place_of_a_spring_that_may_have_no_stiffness(plant, arm, at) -> None:
    real = plant(at(JOINT, lambda q, v, a, t: 2.0 * np.ones_like(v)))
    posed = pose(arm, real.record(1), real.record(2))
    candidate = posed.candidate(posed.select({JOINT: ("joint_spring",)}))
    (gone,) = NegligibleTorque().rejected(candidate)
    assert [posed.library.hypotheses[i].place for i in gone.instead] == [("torque_offset", JOINT)]
    left = candidate.without(gone.index, instead=gone.instead)
    assert [e.effect for e in left.effects] == ["torque_offset"]
    assert NegligibleTorque().rejected(left) == ()


def test_nothing_takes_the_place_of_a_law_without_a_special_case_or_with_one_that_is_excluded(plant, arm) -> None:
    real = plant()
    posed = pose(arm, real.record(1), real.record(2))
    candidate = posed.candidate(posed.select({JOINT: ("viscous_friction", "coulomb_friction")}))
    assert special_case(candidate, posed.index("viscous_friction", JOINT)) == ()
    candidate = posed.candidate(posed.select({JOINT: ("joint_spring", "torque_offset")}))
    assert special_case(candidate, posed.index("joint_spring", JOINT)) == ()
