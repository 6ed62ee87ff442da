"""Noise of the torque sensor is not called elasticity."""

from __future__ import annotations

import pytest

from lagnet.diagnosis.diagnose import diagnose
from lagnet.rigid_body.robot import load_description


@pytest.fixture(scope="module")
def ur10():
    return load_description("ur10")


@pytest.mark.parametrize("seed", [2, 4])
def test_one_joint_that_moves_alone_and_lacks_nothing_gets_no_name(plant, ur10, seed: int) -> None:
    real, rest = plant(robot=ur10), range(1, 6)
    result = diagnose([real.record(seed, hold=rest)], ur10, [real.record(seed + 50, hold=rest)])
    assert result.effects == ()


def test_the_noise_would_have_been_named_otherwise(plant, ur10, monkeypatch) -> None:
    """Shows that the test above can fail: without the step, the second derivative of the noise is taken for bending."""
    monkeypatch.setattr("lagnet.diagnosis.inquiry.drop_echoes", lambda problem, bench, found, fitted: (found, fitted))
    real, rest = plant(robot=ur10), range(1, 6)
    result = diagnose([real.record(4, hold=rest)], ur10, [real.record(54, hold=rest)])
    assert "joint_elasticity" in {e.effect for e in result.effects}
