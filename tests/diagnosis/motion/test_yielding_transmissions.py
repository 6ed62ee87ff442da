"""Elasticity and backlash of plants that another engine moves are named, with their size and the encoder's side."""

from __future__ import annotations

import pytest
from validation.motion_concealed.plants import plant

from lagnet.diagnosis.motion.diagnose import diagnose_motion

CLOSE = 0.1  # of a size: a play shows within a few encoder steps alone


@pytest.mark.slow
@pytest.mark.parametrize(
    ("effect", "index", "parameter"),
    [("joint_elasticity", 2, "K"), ("joint_elasticity", 3, "K"), ("backlash", 2, "b"), ("backlash", 5, "b")],
)
def test_a_yielding_transmission_is_named(effect, index, parameter, tmp_path):
    case = plant(91, index, "pendulum", effect, 16.0, tmp_path)
    found = diagnose_motion(case.recordings[:2], case.robot, case.recordings[2:], servo=case.servo)
    (told,) = found.effects
    values = {p.name: p.value for p in told.parameters}
    assert told.effect == effect
    assert values[parameter] == pytest.approx(case.cause.value, rel=CLOSE)
    assert values["encoder_side"] == (case.cause.side == "link")
    errors = found.verdict.errors[0]
    assert errors.rmse_corrected < 0.7 * errors.rmse_nominal
