"""Noise is measured, not assumed: estimates against noise of known size, and against what filters make of it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lagnet.recordings.conditioning.condition import condition
from lagnet.recordings.conditioning.noise import band_noise, motion_bandwidth, white_noise
from lagnet.recordings.conditioning.smoothing import derivative, low_pass
from lagnet.recordings.recording import Recording

RATE, SAMPLES = 500.0, 6000
# The sixth difference correlates neighbours: the variance of its mean square is 2 Σ ρ_k² / n with Σ ρ_k² = 4.6 over
# both signs of k, so that one standard error of the estimated deviation is sqrt(4.6 / (2 n)) of it.
STANDARD_ERROR = np.sqrt(4.6 / (2 * SAMPLES))
STATISTICAL = 4.0
FILTER_SHAPE = 0.15  # of the deviation: a Butterworth run forth and back is no rectangle in frequency


@given(seed=st.integers(0, 2**31), size=st.floats(1e-6, 1e2))
@settings(max_examples=15, deadline=None)
def test_white_noise_is_found_beneath_motion(seed: int, size: float) -> None:
    time = np.arange(SAMPLES) / RATE
    motion = 1e3 * size * np.sin(2.0 * np.pi * 0.7 * time)[:, None]
    noise = size * np.random.default_rng(seed).standard_normal((SAMPLES, 1))
    assert white_noise(motion + noise)[0] == pytest.approx(size, rel=STATISTICAL * STANDARD_ERROR + 0.01)


def test_quantisation_counts_as_noise_of_its_step() -> None:
    time = np.arange(SAMPLES) / RATE
    step = 1e-3
    q = step * np.round(np.sin(2.0 * np.pi * 0.9 * time) / step)
    assert white_noise(q[:, None])[0] == pytest.approx(step / np.sqrt(12.0), rel=0.15)


def test_smooth_motion_is_no_noise() -> None:
    time = np.arange(SAMPLES) / RATE
    assert white_noise(np.sin(2.0 * np.pi * 2.0 * time)[:, None])[0] < 1e-9


def test_too_few_samples_say_nothing() -> None:
    assert np.array_equal(white_noise(np.ones((5, 2))), np.zeros(2))


@pytest.mark.parametrize("derivatives", [0, 1, 2])
@pytest.mark.parametrize("bandwidth", [8.0, 20.0])
def test_band_noise_is_what_filter_and_derivative_leave(bandwidth: float, derivatives: int) -> None:
    time = np.arange(40_000) / RATE
    x = low_pass(np.random.default_rng(3).standard_normal((time.size, 1)), RATE, bandwidth)
    for _ in range(derivatives):
        x = derivative(time, x)
    found = np.std(x[500:-500])
    assert band_noise(np.array([1.0]), RATE, bandwidth, derivatives)[0] == pytest.approx(found, rel=FILTER_SHAPE)


def test_a_conditioned_recording_states_the_noise_that_it_has() -> None:
    rng, time = np.random.default_rng(6), np.arange(SAMPLES) / RATE
    clean = np.stack([np.sin(3.0 * time), 0.7 * np.cos(2.0 * time)], axis=1)
    noisy = clean + np.array([1e-4, 5e-4]) * rng.standard_normal(clean.shape)
    tau = 10.0 * clean + np.array([0.2, 0.05]) * rng.standard_normal(clean.shape)
    ready = condition([Recording(time, noisy, tau, ("a", "b"))])
    np.testing.assert_allclose(ready.white_q, [1e-4, 5e-4], rtol=STATISTICAL * STANDARD_ERROR + 0.01)
    np.testing.assert_allclose(ready.white_tau, [0.2, 0.05], rtol=STATISTICAL * STANDARD_ERROR + 0.01)
    stretch, inside = ready.stretches[0], slice(500, -500)
    left = np.std((low_pass(stretch.tau, RATE, ready.bandwidth) - 10.0 * clean)[inside], axis=0)
    np.testing.assert_allclose(ready.noise_tau, left, rtol=FILTER_SHAPE)
    acceleration = np.stack([-9.0 * np.sin(3.0 * time), -2.8 * np.cos(2.0 * time)], axis=1)
    error = np.std(low_pass(stretch.a - acceleration, RATE, ready.bandwidth)[inside], axis=0)
    np.testing.assert_allclose(ready.noise_a, error, rtol=2 * FILTER_SHAPE)


def test_the_motion_s_bandwidth_is_that_of_its_quickest_harmonic_of_weight() -> None:
    time = np.arange(10_000) / 100.0
    q = np.sin(2.0 * np.pi * 0.5 * time) + 0.2 * np.sin(2.0 * np.pi * 1.5 * time)
    still = np.zeros_like(q)
    assert motion_bandwidth(np.stack([q, still], axis=1), 100.0) == pytest.approx(1.5, abs=0.05)
    assert motion_bandwidth(np.zeros((100, 2)), 100.0) == 0.0


@pytest.mark.parametrize(("shakes", "expected"), [(37.0, 1.5), (6.0, 6.0)], ids=["vibration", "quick motion"])
def test_what_shakes_a_decade_above_the_motion_is_none(shakes, expected) -> None:
    time = np.arange(10_000) / 100.0
    q = np.sin(2.0 * np.pi * 0.5 * time) + 0.2 * np.sin(2.0 * np.pi * 1.5 * time)
    tremor = 0.1 / shakes * np.sin(2.0 * np.pi * shakes * time)  # a thirty-fifth of the speeds' power
    assert motion_bandwidth((q + tremor)[:, None], 100.0) == pytest.approx(expected, abs=0.05)
