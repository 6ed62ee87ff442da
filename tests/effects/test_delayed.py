"""A delayed signal is that of a cubic spline asked earlier, on even clocks and on others."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from lagnet.effects.delayed import earlier

STEP, N = 0.01, 400
ENDS = 30  # samples within which the two splines' conditions at the ends differ


def signal(time: np.ndarray) -> np.ndarray:
    return np.sin(7.0 * time) + 0.3 * np.cos(31.0 * time)


@pytest.mark.parametrize("delay", [0.0, STEP, -STEP, 0.0123, -0.0123, 0.2, -0.25, 1e-9, -1e-9])
@pytest.mark.parametrize("start", [0.0, 12.3])
def test_it_is_the_spline_asked_earlier(delay: float, start: float) -> None:
    time = start + STEP * np.arange(N)
    expected = CubicSpline(time, signal(time))(np.clip(time - delay, time[0], time[-1]))
    found = earlier(time, signal(time), delay)
    np.testing.assert_allclose(found[ENDS:-ENDS], expected[ENDS:-ENDS], atol=1e-12)
    np.testing.assert_allclose(found, expected, atol=2e-2)


@pytest.mark.parametrize("delay", [0.013, -0.013])
def test_before_the_first_sample_and_after_the_last_it_stays(delay: float) -> None:
    time = STEP * np.arange(N)
    found = earlier(time, signal(time), delay)
    outside = (time - delay < time[0]) | (time - delay > time[-1])
    assert outside.sum() == 2
    np.testing.assert_allclose(found[outside], signal(time)[0 if delay > 0.0 else -1])


@pytest.mark.parametrize(("delay", "row"), [(99.0, 0), (-99.0, -1)])
def test_a_delay_beyond_the_recording_leaves_its_end(delay: float, row: int) -> None:
    time = STEP * np.arange(N)
    np.testing.assert_array_equal(earlier(time, signal(time), delay), np.full(N, signal(time)[row]))


def test_an_uneven_clock_is_asked_where_it_is() -> None:
    time = np.cumsum(STEP * (1.0 + 0.5 * np.random.default_rng(0).random(N)))
    expected = CubicSpline(time, signal(time))(np.clip(time - 0.0123, time[0], time[-1]))
    np.testing.assert_allclose(earlier(time, signal(time), 0.0123), expected)


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5])
def test_few_samples_are_enough(n: int) -> None:
    time = STEP * np.arange(n)
    found = earlier(time, 2.0 + 3.0 * time, 0.5 * STEP)
    np.testing.assert_allclose(found, 2.0 + 3.0 * np.maximum(time - 0.5 * STEP, 0.0), atol=2e-3)


def test_whole_numbers_are_taken_as_numbers() -> None:
    time = STEP * np.arange(20)
    np.testing.assert_allclose(earlier(time, np.arange(20), STEP)[5:], np.arange(4, 19), atol=1e-4)
