"""Faults that random samples miss are found where they are worst."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from validation.mutants.bench import Assembled

from lagnet.errors import ModelError
from lagnet.plausibility.search import closer_and_closer
from lagnet.plausibility.settings import CheckSettings
from lagnet.plausibility.suite import check
from lagnet.rigid_body.random_arm import random_arm

ARM = random_arm(2, 3, ("revolute",), fixed=False)
PLACE = (0.45 * ARM.position_lower + 0.55 * ARM.position_upper)[None]
LIGHT = CheckSettings(samples=48, starts=2, iterations=10)


def bump(q: np.ndarray, width: float) -> np.ndarray:
    """One at PLACE, falling off over a share of the joints' range, shape (n, 1)."""
    share = (q - PLACE) / (ARM.position_upper - ARM.position_lower)
    return np.exp(-np.sum((share / width) ** 2, axis=1, keepdims=True))


def test_number_that_is_not_finite_is_found_where_torque_is_largest():
    def torque(q, v, a):
        peak = bump(q, 0.3)
        return ARM.inverse_dynamics(q, v, a) + np.where(peak > 0.9999, np.nan, 1e4 * peak)

    broken = Assembled(ARM, inverse_dynamics=torque)
    found = check(broken, settings=LIGHT)["finite_output"]
    assert found.status == "fail"
    np.testing.assert_allclose(found.where["q"], PLACE[0], atol=0.02)


def test_dependence_on_neighbours_is_found_where_it_is_worst():
    def torque(q, v, a):
        tau = ARM.inverse_dynamics(q, v, a)
        return tau + 1e-3 * bump(q, 0.1) * tau.mean(axis=0)

    found = check(Assembled(ARM, inverse_dynamics=torque), settings=LIGHT)["independent_samples"]
    assert found.status == "fail"
    assert float(bump(np.array([found.where["q"]]), 0.1)[0, 0]) > 0.9


def test_worst_place_against_a_reference_is_searched_for():
    off = Assembled(ARM, gravity_torque=lambda q: ARM.gravity_torque(q) + 50.0 * bump(q, 0.1))
    found = check(off, ARM, settings=LIGHT)["reference_gravity"]
    assert found.status == "fail"
    assert "differs by up to 50 N m" in found.detail
    np.testing.assert_allclose(found.where["q"], PLACE[0], atol=0.01)


def test_comparison_tells_every_joint_with_its_interval():
    heavier = ARM.with_inertial_parameters(1.1 * ARM.inertial_parameters())
    found = check(heavier, ARM, settings=LIGHT)["reference_gravity"]
    assert [entry["joint"] for entry in found.joints] == list(ARM.joints)
    for entry in found.joints:
        low, high = entry["ci95"]
        assert low <= entry["value"] <= high
        assert 0.01 <= entry["value"] < 0.02  # a tenth too heavy, squared, and the mean that variance leaves out


def test_reference_that_is_not_finite_is_bad_input():
    broken = Assembled(ARM, gravity_torque=lambda q: np.full_like(q, np.nan))
    with pytest.raises(ModelError, match="gravity_torque of the reference"):
        check(ARM, broken, settings=replace(LIGHT, samples=16))


def test_rounds_of_neighbours_climb_and_stay_in_the_box():
    top = np.array([1.0, 0.4])
    seen = []

    def measure(points: np.ndarray) -> np.ndarray:
        seen.append(points)
        return -np.sum((points - top) ** 2, axis=1)

    start = np.array([0.8, 0.3])
    value = float(measure(start[None])[0])
    worst = closer_and_closer(measure, start, value, np.random.default_rng(0))
    assert worst.value > value
    assert worst.value == measure(worst.point[None])[0]
    assert all(np.abs(points).max() <= 1.0 for points in seen)


@pytest.mark.parametrize("seed", range(5))
def test_perceptron_grows_no_faster_than_its_inputs_although_its_units_cancel_in_places(seed: int):
    rng = np.random.default_rng(seed)
    inward, bias, outward = rng.normal(size=(16, 6)), 5.0 * rng.normal(size=16), rng.normal(size=(2, 16))

    def residual(q, v, a):
        seen = np.concatenate([np.sin(q), v, a], axis=1) @ inward.T + bias
        return np.maximum(seen, 0.0) @ outward.T

    found = check(Assembled(ARM, residual_torque=residual), settings=LIGHT)["bounded_growth"]
    assert found.status == "pass", found.sentence()
