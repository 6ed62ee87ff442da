"""A name is held to the joints where it helps: what another joint hides does not take it away."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.diagnose import diagnose

MASS = 1.5  # [kg]
LIMIT = 1.0  # [N m] that the sensor of one joint cannot exceed in one direction, which is in no catalogue


@pytest.mark.slow
def test_a_sensor_that_fails_at_one_joint_does_not_hide_a_payload(plant, arm, at) -> None:
    loaded = arm.with_payload(MASS, np.array([0.05, 0.08, 0.15]), 0.006 * np.eye(3))
    real = plant(at(0, lambda q, v, a, body: np.minimum(body, LIMIT) - body), robot=loaded)
    result = diagnose([real.record(1), real.record(2)], arm, [real.record(3)])
    payload = next(e for e in result.effects if e.effect == "payload")
    assert payload.value("m") == pytest.approx(MASS, rel=0.1)
    left = {u.joint: u.above_noise for u in result.verdict.unexplained}
    assert left[arm.joints[0]]
