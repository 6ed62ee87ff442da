"""The noise floor is the residual that a right model leaves."""

from __future__ import annotations

import numpy as np
from tests.diagnosis.posed import pose

from lagnet.diagnosis.problem.noise_floor import noise_floor


def test_it_is_the_residual_of_a_right_model(plant, arm) -> None:
    real = plant()
    posed = pose(arm, real.record(71), real.record(72))
    left = np.concatenate([posed.problem.residual(p) for p in posed.problem.fit])
    ratio = np.sqrt(np.mean(left**2, axis=0)) / posed.noise
    assert np.all((ratio > 0.5) & (ratio < 1.6)), ratio


def test_it_does_not_grow_with_left_out_physics(plant, arm, at) -> None:
    real, missing = plant(), plant(at(1, lambda q, v, a, t: 4.0 * v))
    free = pose(arm, real.record(73), real.record(74)).noise
    assert np.all(pose(arm, missing.record(73), missing.record(74)).noise < 1.5 * free)


def test_the_same_seed_gives_the_same_floor(plant, arm) -> None:
    posed = pose(arm, plant().record(75), plant().record(76))
    np.testing.assert_array_equal(noise_floor(posed.problem, posed.fit, 3), noise_floor(posed.problem, posed.fit, 3))
