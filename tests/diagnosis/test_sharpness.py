"""The speed over which dry friction changes sign is taken from the recordings."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.sharpness import FACTORS, sharpen


def test_soft_friction_widens_the_sign_of_its_joint_alone(plant, arm, at) -> None:
    soft = 0.1
    real = plant(at(1, lambda q, v, a, t: 4.0 * np.tanh(v / soft)))
    problem = pose(arm, real.record(51), real.record(52)).problem
    sharpened = sharpen(problem)
    step = FACTORS[-1] / FACTORS[-2]
    assert soft / step < sharpened.slow[1] < soft * step
    assert sharpened.slow[1] > 2.0 * problem.slow[1]
    np.testing.assert_array_equal(sharpened.slow[[0, 2]], problem.slow[[0, 2]])


@pytest.mark.parametrize(
    "law",
    [lambda q, v, a, t: 4.0 * v, lambda q, v, a, t: 3.0 * a, lambda q, v, a, t: 3.0 * v * np.abs(v)],
    ids=["viscous", "rotor", "drag"],
)
def test_what_is_no_dry_friction_changes_nothing(plant, arm, at, law) -> None:
    real = plant(at(1, law))
    problem = pose(arm, real.record(53), real.record(54)).problem
    np.testing.assert_array_equal(sharpen(problem).slow, problem.slow)
