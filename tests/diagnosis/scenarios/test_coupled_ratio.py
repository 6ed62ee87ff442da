"""A motor that turns with two joints is named at its ratio, and nothing beside it."""

from __future__ import annotations

import pytest
from tests.diagnosis.estimation.rubbing import DRY, JOINT, NAME, rubbing

from lagnet.diagnosis.diagnose import diagnose

NEAR = 0.03


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [2.2, -0.6, -0.9, 1.0])
def test_a_coupled_motor_is_named_at_its_ratio(plant, arm, names, ratio: float) -> None:
    real = plant(rubbing(ratio))
    result = diagnose([real.record(71)], arm, [real.record(72)])
    assert names(result) == {(NAME, arm.joints[JOINT])}
    (effect,) = result.effects
    assert (effect.value("ratio"), effect.value("Fc")) == pytest.approx((ratio, DRY), rel=NEAR)
