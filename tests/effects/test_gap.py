"""A link in its gap: on the flank that its load presses it to, and in free flight between."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lagnet.effects.gap import lag_in_gap

RATE = 100.0  # [Hz]
TIME = np.arange(200) / RATE


def fallen(push, half_gap: float, finer: int = 400) -> np.ndarray:
    """The same by many small steps."""
    out, x, w, side, free = np.empty(TIME.size), 0.0, 0.0, 1.0 if push[0] >= 0 else -1.0, False
    x = side * half_gap
    for k in range(TIME.size):
        out[k] = x
        for now in np.interp(np.arange(finer) / finer, [0, 1], [push[k], push[min(k + 1, TIME.size - 1)]]):
            free = free or now * side < 0.0
            if free:
                w += now / RATE / finer
                x += w / RATE / finer
                if abs(x) > half_gap:
                    x, side, w, free = np.copysign(half_gap, x), np.sign(x), 0.0, False
    return out


def test_a_load_that_never_changes_sign_keeps_its_flank() -> None:
    np.testing.assert_array_equal(lag_in_gap(TIME, np.full(TIME.size, -3.0), 0.01), -0.01)
    np.testing.assert_array_equal(lag_in_gap(TIME, np.full(TIME.size, 3.0), 0.01), 0.01)


def test_a_steady_change_of_load_takes_the_time_that_free_fall_needs() -> None:
    slope, half_gap, crossed = 30.0, 0.004, 1.003
    lag = lag_in_gap(TIME, slope * (TIME - crossed), half_gap)
    flight = (12.0 * half_gap / slope) ** (1.0 / 3.0)
    since = TIME - crossed
    inside = (since > 0.0) & (since < flight)
    np.testing.assert_allclose(lag[inside], -half_gap + slope * since[inside] ** 3 / 6.0, rtol=0, atol=1e-12)
    np.testing.assert_array_equal(lag[since <= 0.0], -half_gap)
    np.testing.assert_array_equal(lag[since > flight], half_gap)


def test_a_load_that_turns_back_soon_enough_returns_the_link_to_its_flank() -> None:
    push = np.where((TIME > 0.5) & (TIME < 0.55), -1.0, 4.0)
    lag = lag_in_gap(TIME, push, 0.02)
    assert -0.02 < lag.min() < 0.02
    np.testing.assert_array_equal(lag[TIME > 1.0], 0.02)


@given(seed=st.integers(0, 2**31), half_gap=st.floats(1e-4, 0.01))
@settings(max_examples=6, deadline=None)
def test_the_flight_is_that_of_many_small_steps(seed: int, half_gap: float) -> None:
    rng = np.random.default_rng(seed)
    push = np.sum(
        [rng.normal() * 5 * np.sin(2 * np.pi * f * TIME + rng.uniform(0, 6)) for f in (0.7, 1.5, 2.6)], axis=0
    )
    lag, expected = lag_in_gap(TIME, push, half_gap), fallen(push, half_gap)
    assert np.abs(lag).max() <= half_gap
    apart = np.abs(lag - expected) / half_gap
    assert np.median(apart) < 1e-5
    assert np.mean(apart > 0.05) < 0.05  # samples in the midst of a landing


@pytest.mark.parametrize("half_gap", [1e-5, 1e-3, 0.1])
def test_a_gap_of_any_width_gives_finite_angles(half_gap: float) -> None:
    push = np.random.default_rng(1).normal(size=TIME.size)
    lag = lag_in_gap(TIME, push, half_gap)
    assert np.all(np.isfinite(lag))
    assert np.abs(lag).max() <= half_gap
