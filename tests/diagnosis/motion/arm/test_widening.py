"""How much a further free parameter widens the intervals of the others."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.motion.arm.intervals import widening

SAMPLES, NOISE = 20000, 1e-2
FLOOR = np.array([1e-9])


def correlated(rho: float) -> tuple[np.ndarray, np.ndarray]:
    """White errors, and sensitivities of two parameters that are correlated by ρ."""
    rng = np.random.default_rng(3)
    one, other, errors = rng.standard_normal((3, SAMPLES))
    return NOISE * errors, np.column_stack([one, rho * one + np.sqrt(1.0 - rho**2) * other])


@pytest.mark.parametrize("rho", [0.0, 0.6, 0.95])
def test_a_correlated_parameter_widens_by_the_root_of_one_less_its_square(rho):
    errors, slopes = correlated(rho)
    scatter = 4.0 / np.sqrt(2 * 40)  # of a standard deviation from 40 blocks
    assert widening([errors], [slopes], FLOOR, [1]) == pytest.approx(1.0 / np.sqrt(1.0 - rho**2), rel=scatter)


def test_what_no_motion_tells_apart_widens_without_bound():
    errors, slopes = correlated(1.0)
    assert widening([errors], [slopes], FLOOR, [1]) == np.inf


def test_the_only_parameter_widens_nothing():
    errors, slopes = correlated(0.5)
    assert widening([errors], [slopes], FLOOR, [0, 1]) == 1.0


def test_a_parameter_that_motion_does_not_show_has_no_interval_to_widen():
    errors, slopes = correlated(0.6)
    blind = np.column_stack([slopes, 1e-9 * np.random.default_rng(4).standard_normal(SAMPLES)])
    alone = widening([errors], [slopes], FLOOR, [1])
    assert widening([errors], [blind], FLOOR, [1]) == pytest.approx(alone, rel=1e-2)  # the count of parameters enters
