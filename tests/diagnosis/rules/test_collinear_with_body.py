"""Small names beside a payload that only take back what its fit overdid are left out; small ones of their own stay."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.posed import Posed, pose

from lagnet.diagnosis.rules.apply import apply_rules
from lagnet.diagnosis.rules.collinear_with_body import CollinearWithBody
from lagnet.diagnosis.selection.arm_search import Selection

MASS = 1.5  # [kg]


@pytest.fixture(scope="module")
def loaded(arm):
    return arm.with_payload(MASS, np.array([0.05, 0.08, 0.15]), 0.006 * np.eye(3))


def eliminated(posed: Posed, keep_friction: bool) -> Selection:
    """What is left of the payload with a gain at every joint, whether the search chose them or not."""
    local = {j: ("torque_gain",) for j in range(posed.problem.n_dof)}
    if keep_friction:
        local[1] = ("torque_gain", "viscous_friction")
    selection = posed.select(local, ("payload",))
    return apply_rules([CollinearWithBody()], posed.candidate(selection)).candidate.selection


def test_gains_that_a_payload_does_not_need_go(plant, arm, loaded) -> None:
    real = plant(robot=loaded)
    posed = pose(arm, real.record(1), real.record(2))
    found = eliminated(posed, False)
    assert len(found.arm_wide) == 1
    assert found.local == ((), (), ())
    assert set(found.fit.coefficients) == set(found.indices)


def test_a_small_effect_of_its_own_stays(plant, arm, loaded, at) -> None:
    level = 0.1 * plant(robot=loaded).usual_torque()[1]
    real = plant(at(1, lambda q, v, a, body: level * v), robot=loaded)
    posed = pose(arm, real.record(1), real.record(2))
    found = eliminated(posed, True)
    kept = [posed.library.hypotheses[i].place for own in found.local for i in own]
    assert ("viscous_friction", 1) in kept
    assert not any(name == "torque_gain" and joint != 1 for name, joint in kept)
