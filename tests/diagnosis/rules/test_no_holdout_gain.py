"""Effects that held-out recordings do not need have no name, alone or where they cancel each other."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.rules.no_holdout_gain import NoHoldoutGain
from lagnet.diagnosis.selection.holdout_gain import opposed_pairs, ratio_without

JOINT = 1
TAUT = -2.5  # [N m] of load, above which a cable pulls; held out, the load stays below it


@pytest.fixture(scope="module")
def of_both(arm, plant, at):
    """A gain and an offset in the place of a law of the load, on held-out motion with the load of some seed."""

    def make(law, held_out: int):
        real = plant(at(JOINT, law))
        posed = pose(arm, real.record(3), real.record(held_out))
        return posed.candidate(posed.select({JOINT: ["torque_gain", "torque_offset"]}))

    return make


def taut(q, v, a, load):
    return 0.5 * np.maximum(load - TAUT, 0.0)


def test_two_that_cancel_each_other_where_nothing_acts_go(of_both) -> None:
    candidate = of_both(taut, 2)
    assert all(p.without > 2.0 * p.with_it for p in candidate.holdout_gain.values()), "each needs the other"
    found = NoHoldoutGain().rejected(candidate)
    assert {r.effect for r in found} == {"torque_gain", "torque_offset"}
    assert all(r.value < 1.0 and " and " in r.detail for r in found)


def test_two_that_cancel_each_other_in_part_stay_where_both_act(of_both) -> None:
    candidate = of_both(lambda q, v, a, load: 0.2 * load + 0.6, 2)
    assert NoHoldoutGain().rejected(candidate) == ()


def test_two_that_cancel_each_other_stay_where_held_out_motion_meets_what_they_stand_for(of_both) -> None:
    assert NoHoldoutGain().rejected(of_both(taut, 8)) == ()


@pytest.mark.parametrize(("held_out", "needed"), [(4, False), (6, False), (8, True)])
def test_all_of_a_joint_go_where_held_out_motion_needs_none_of_them(arm, plant, at, held_out, needed) -> None:
    real = plant(at(JOINT, taut))
    posed = pose(arm, real.record(3), real.record(held_out))
    names = ["torque_gain", "joint_spring", "viscous_friction"]
    found = posed.select({JOINT: names})
    candidate = posed.candidate(found)
    unseen = candidate.holdout_equations
    assert all(p.without > 1.02 * p.with_it for p in candidate.holdout_gain.values()), "each needs the others"
    pairs = [ratio_without(posed.equations, unseen, found, p, candidate.sigma) for p in opposed_pairs(unseen, found)]
    assert all(ratio > 1.02 for ratio in pairs), "no two of them are needless"
    assert {r.effect for r in NoHoldoutGain().rejected(candidate)} == (set() if needed else set(names))
