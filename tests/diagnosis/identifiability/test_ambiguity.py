"""A claim that could be any of many laws is told as an abstention."""

from __future__ import annotations

import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.identifiability.ambiguity import ambiguous_causes
from lagnet.diagnosis.identifiability.rivals import Comparison
from lagnet.diagnosis.settings import DecisionLimits

RIVALS = ("backlash", "coulomb_friction", "joint_spring", "time_delay", "torque_gain")


@pytest.fixture(scope="module")
def posed(plant, arm, at):
    real = plant(at(1, lambda q, v, a, t: 4.0 * v))
    return pose(arm, real.record(1), real.record(2))


@pytest.mark.parametrize("rivals", range(len(RIVALS) + 1))
def test_more_names_than_a_claim_may_stand_for_are_too_many(posed, rivals: int) -> None:
    found = posed.search()
    (index,) = found.indices
    most = DecisionLimits().most_names
    vague = ambiguous_causes(posed.library, [Comparison(index, (), RIVALS[:rivals])], most)
    assert bool(vague) == (1 + rivals > most)
    assert all(v.effect == "viscous_friction" and set(v.tied) == set(RIVALS[:rivals]) for v in vague.values())
    assert all(name in v.reason for v in vague.values() for name in v.tied)
    assert posed.candidate(found).without(*vague).indices == (() if vague else (index,))
