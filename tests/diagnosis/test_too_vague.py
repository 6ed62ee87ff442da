"""A claim that could be any of many laws is told as an abstention."""

from __future__ import annotations

import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.rivals import Contest
from lagnet.diagnosis.too_vague import MOST_NAMES, all_without, too_vague

RIVALS = ("backlash", "coulomb_friction", "joint_spring", "time_delay", "torque_gain")


@pytest.fixture(scope="module")
def posed(plant, arm, at):
    real = plant(at(1, lambda q, v, a, t: 4.0 * v))
    return pose(arm, real.record(1), real.record(2))


@pytest.mark.parametrize("rivals", range(len(RIVALS) + 1))
def test_more_names_than_a_claim_may_stand_for_are_too_many(posed, rivals: int) -> None:
    found = posed.search()
    (index,) = found.selection
    vague = too_vague(posed.library, [Contest(index, (), RIVALS[:rivals])])
    assert bool(vague) == (1 + rivals > MOST_NAMES)
    assert all(v.effect == "viscous_friction" and set(v.tied) == set(RIVALS[:rivals]) for v in vague.values())
    assert all(name in v.reason for v in vague.values() for name in v.tied)
    assert all_without(posed.bench, found, [*vague]).selection == (() if vague else (index,))
