"""A damped spring against the solution by hand, on even clocks and on others."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.effects.damped import damped

OMEGA, N, STEP = 7.0, 600, 0.01
CLOSE = 2e-3  # x is taken as straight between samples


def by_hand(time: np.ndarray, constant: float) -> np.ndarray:
    """e of T de/dt + e = sin ωt from e = 0 at t = 0."""
    gain = 1.0 / (1.0 + (OMEGA * constant) ** 2)
    steady = gain * (np.sin(OMEGA * time) - OMEGA * constant * np.cos(OMEGA * time))
    return steady + gain * OMEGA * constant * np.exp(-time / constant)


@pytest.mark.parametrize("constant", [1e-4, 0.004, 0.03, 0.25])
@pytest.mark.parametrize("jitter", [0.0, 0.4])
def test_it_is_the_solution_by_hand(constant: float, jitter: float) -> None:
    steps = STEP * (1.0 + jitter * np.random.default_rng(0).uniform(-1.0, 1.0, N))
    time = np.concatenate([[0.0], np.cumsum(steps)])
    np.testing.assert_allclose(damped(time, np.sin(OMEGA * time), constant), by_hand(time, constant), atol=CLOSE)


def test_both_clocks_agree() -> None:
    time = STEP * np.arange(N)
    uneven = time + np.where(np.arange(N) == N - 1, 1e-3, 0.0)
    even = damped(time, np.sin(time), 0.02)
    np.testing.assert_allclose(damped(uneven, np.sin(time), 0.02)[:-1], even[:-1], rtol=1e-10, atol=1e-12)


@pytest.mark.parametrize("n", [0, 1, 2, 5])
def test_without_damping_it_is_the_load(n: int) -> None:
    time = STEP * np.arange(n)
    np.testing.assert_array_equal(damped(time, np.cos(time), 0.0), np.cos(time))
    np.testing.assert_allclose(damped(time, np.cos(time), 1e-9), np.cos(time), atol=1e-6)


@pytest.mark.parametrize("constant", [1e-6, 0.02, 5.0])
def test_under_a_constant_load_it_stays(constant: float) -> None:
    np.testing.assert_allclose(damped(STEP * np.arange(N), np.full(N, 3.0), constant), 3.0, rtol=1e-12)
