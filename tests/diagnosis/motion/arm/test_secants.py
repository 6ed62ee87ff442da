"""Intervals of values that motion shows in steps hold the truth; where it is smooth they are those of its slope."""

from __future__ import annotations

import numpy as np
import pytest
from tests.tolerances import IDENTITY

from lagnet.diagnosis.motion.arm.fitting import sensitivities_of
from lagnet.diagnosis.motion.arm.intervals import half_widths
from lagnet.diagnosis.motion.arm.profiles import WIDER, profiled_ends
from lagnet.diagnosis.motion.arm.secants import Secants, settled_secants

SAMPLES, BLOCKS, NOISE, STEP = 800, 40, 1e-3, 0.15  # STEP: way of the value from one start to the next in a block
FLOOR, SIZES, TRUE = np.array([1e-4]), np.array([1.0]), 1.0
EFFECT = 0.01  # [rad] by which a block moves as the value doubles


class Staircase:
    """One joint whose rest position in each block of time is a step of the value, and noise on it."""

    def __init__(self, seed: int):
        rng = np.random.default_rng(seed)
        self.at = np.repeat(rng.uniform(0.0, 1.0, BLOCKS), SAMPLES // BLOCKS)
        self.measured = self.predicted(TRUE) + NOISE * rng.standard_normal(SAMPLES)

    def predicted(self, value: float) -> np.ndarray:
        return EFFECT * STEP * np.floor(value / STEP + self.at)

    def errors(self, values: np.ndarray) -> list[np.ndarray]:
        return [self.predicted(float(values[0])) - self.measured]

    def fitted(self) -> np.ndarray:
        grid = np.arange(0.7, 1.3, 0.002)
        return grid[[np.argmin([np.sum(self.errors(np.array([x]))[0] ** 2) for x in grid])]]


def ends_of(joint: Staircase, values: np.ndarray) -> tuple[np.ndarray, Secants]:
    here = joint.errors(values)
    found = settled_secants(joint.errors, values, here, SIZES, FLOOR)
    return profiled_ends(joint.errors, values, here, found, SIZES, FLOOR)[:, 0], found


def test_intervals_of_a_staircase_hold_the_truth_and_those_of_its_derivative_do_not():
    held, narrow, widths = 0, 0, []
    for seed in range(40):
        joint = Staircase(seed)
        values = joint.fitted()
        (low, high), _ = ends_of(joint, values)
        held += low <= TRUE <= high
        widths.append(high - low)
        here = joint.errors(values)
        half, _ = half_widths(here, sensitivities_of(joint.errors, SIZES)(values, here), FLOOR, np.eye(1))
        narrow += not abs(values[0] - TRUE) <= half[0]
    assert held >= 37  # 95 % of 40, less one standard error
    assert narrow >= 10  # what a difference within a step says
    assert np.median(widths) < 0.3


def test_a_value_that_nothing_shows_is_open_to_its_bounds():
    def errors(values: np.ndarray) -> list[np.ndarray]:
        return [np.full(SAMPLES, 1e-3) + 0.01 * values[0] * np.linspace(-1.0, 1.0, SAMPLES)]

    def nearest(values: np.ndarray) -> np.ndarray:
        return np.clip(values, 0.0, 3.0)

    values, sizes = np.array([1.0, 0.5]), np.ones(2)
    here = errors(values)
    found = settled_secants(errors, values, here, sizes, FLOOR, nearest)
    low, high = profiled_ends(errors, values, here, found, sizes, FLOOR, nearest)
    assert found.half[1] == pytest.approx(2.5)
    assert (low[1], high[1]) == (0.0, 3.0)
    assert 0.0 < found.half[0] < 0.5


def test_two_values_of_which_motion_shows_the_sum_may_be_all_or_nothing_of_it():
    signal = np.sin(np.linspace(0.0, 30.0, SAMPLES))

    def errors(values: np.ndarray) -> list[np.ndarray]:
        noise = NOISE * np.random.default_rng(1).standard_normal(SAMPLES)
        return [0.1 * (values.sum() - 0.5) * signal + noise]

    def nearest(values: np.ndarray) -> np.ndarray:
        return np.maximum(values, 0.0)

    values, sizes = np.array([0.1, 0.4]), np.ones(2)
    half = settled_secants(errors, values, errors(values), sizes, FLOOR, nearest).half
    assert half == pytest.approx([0.4, 0.4], rel=0.05)  # until the other is 0


def smooth(seed: int):
    rng = np.random.default_rng(seed)
    slope, noise = rng.standard_normal((2, SAMPLES))
    noise -= slope * (slope @ noise) / (slope @ slope)  # the fit has its least squares at 1

    def errors(values: np.ndarray) -> list[np.ndarray]:
        return [0.01 * slope * (values[0] - 1.0) + NOISE * noise]

    return errors


def test_smooth_motion_keeps_the_intervals_of_its_derivative():
    for seed in range(5):
        errors, values = smooth(seed), np.ones(1)
        here = errors(values)
        half, _ = half_widths(here, sensitivities_of(errors, SIZES)(values, here), FLOOR, np.eye(1))
        found = settled_secants(errors, values, here, SIZES, FLOOR)
        assert np.abs(found.half - half).max() < IDENTITY
        low, high = profiled_ends(errors, values, here, found, SIZES, FLOOR)
        assert [low[0], high[0]] == pytest.approx([1.0 - half[0], 1.0 + half[0]], abs=IDENTITY)


def test_a_fit_that_stopped_short_reaches_the_value_of_least_loss():
    errors = smooth(3)
    half = settled_secants(errors, np.ones(1), errors(np.ones(1)), SIZES, FLOOR).half[0]
    values = np.array([1.0 - 3.0 * half])
    here = errors(values)
    found = settled_secants(errors, values, here, SIZES, FLOOR)
    low, high = profiled_ends(errors, values, here, found, SIZES, FLOOR)
    assert low[0] == pytest.approx(values[0] - found.half[0], abs=IDENTITY)
    assert 1.0 < high[0] <= values[0] + WIDER**6 * found.half[0]
