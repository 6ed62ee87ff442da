"""What smoothing takes from a start is given back where a rollout predicts it, and where it does not, nothing."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.motion.sharpened_rates import confirmed, sharpened_rates
from lagnet.diagnosis.motion.smoothing import motion_rates

TIME = np.arange(0.0, 4.0, 0.02)


def start_at(begun: float) -> np.ndarray:
    """A joint that rests, accelerates by 10 rad/s² for 0.1 s and goes on, shape (n, 1) [rad]."""
    since = np.clip(TIME - begun, 0.0, None)
    short = np.minimum(since, 0.1)
    return (5.0 * short**2 + (since - short) * 1.0)[:, None]


def errors(begun: float, predicted: float) -> tuple[float, float]:
    """Errors of the smoothed and of the sharpened acceleration, in the mean over samples [rad/s²]."""
    q, p = start_at(begun), start_at(predicted)
    true = np.where((begun < TIME) & (begun + 0.1 > TIME), 10.0, 0.0)
    return tuple(
        float(np.mean(np.abs(a[:, 0] - true))) for a in (motion_rates(TIME, q)[1], sharpened_rates(TIME, q, p)[1])
    )


def test_a_start_that_is_predicted_is_sharp_again():
    smoothed, sharp = errors(1.01, 1.01)
    assert sharp < 0.25 * smoothed  # its two ends lie between samples


def test_a_start_predicted_half_a_second_early_changes_nothing():
    smoothed, sharp = errors(1.51, 1.01)
    assert sharp == pytest.approx(smoothed, rel=1e-6)


def test_the_confirmed_share_is_bounded():
    p = np.random.default_rng(0).normal(size=(400, 3))
    shares = confirmed(p * np.array([0.4, -0.5, 3.0]), p)
    assert shares == pytest.approx([0.4, 0.0, 1.0])
    assert np.array_equal(confirmed(p, np.zeros_like(p)), np.zeros(3))
