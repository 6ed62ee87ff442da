"""A motion that is cut in two goes on at the cut; recordings start at rest; duty counts where all have it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lagnet.diagnosis.motion.problem import greatest_duty, start_speed
from lagnet.recordings.recording import Recording

SMOOTHED = 0.01  # share of the speed that a cubic over 0.16 s misses of a sine of 3 rad/s


def swing() -> Recording:
    time = np.arange(0.0, 4.0, 0.01)
    q = np.sin(3.0 * time)[:, None]
    return Recording(time, q, None, ("servo",), command=q, path="swing")


def test_a_motion_goes_on_where_it_was_cut():
    whole = swing()
    before, after = whole.rows(slice(0, 314)), whole.rows(slice(314, None))
    assert start_speed(after, before)[0] == pytest.approx(3.0 * np.cos(3.0 * 3.14), rel=SMOOTHED)


def test_another_recording_starts_at_rest():
    whole = swing()
    before, after = whole.rows(slice(0, 200)), whole.rows(slice(314, None))
    assert np.all(start_speed(after, None) == 0.0)
    assert np.all(start_speed(after, before) == 0.0)  # a second lies between


def test_greatest_duty_is_not_known_where_one_recording_has_none():
    whole = swing()
    low, high = (replace(whole, duty=share * np.ones_like(whole.q)) for share in (0.3, -0.9))
    assert greatest_duty([low, high])[0] == 0.9
    assert np.isnan(greatest_duty([low, whole])[0])
