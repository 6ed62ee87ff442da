"""A rival that is made of the noise of the measured torque gains nothing by explaining that noise."""

from __future__ import annotations

from dataclasses import replace

import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.identifiability.rivals import compare_with_rivals

ELASTICITY, LINK = "joint_elasticity", "link_inertia"


@pytest.mark.parametrize("heavier", [1.02, 1.05])
def test_a_small_change_of_a_link_is_not_tied_with_a_law_that_is_made_of_noise(plant, arm, heavier: float) -> None:
    bodies = arm.inertial_parameters()
    bodies[1] *= heavier
    real = replace(plant(robot=arm.with_inertial_parameters(bodies)), noise=0.1)
    posed = pose(arm, real.record(1), real.record(2))
    (found,) = compare_with_rivals(posed.equations, posed.search())
    assert posed.library.hypotheses[found.index].effect == LINK
    assert dict(found.rivals)[ELASTICITY] > posed.problem.limits.tie_odds
    assert ELASTICITY not in found.tied
