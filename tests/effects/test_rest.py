"""Dry friction at rest: what a stop leaves of it, and how that gives way."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.effects.rest import blurred_sign, held_direction, resting

SLOW = 0.01  # [rad/s]
TIME = np.arange(400) * 0.01


def stop_and_go(after: float) -> np.ndarray:
    """Speed that falls from 1 to nothing, stays there, and grows again in a direction, slowly at first [rad/s]."""
    down, up = np.clip((1.0 - TIME) / 0.5, 0.0, 1.0), np.clip((TIME - 2.0) / 0.5, 0.0, 1.0)
    return down + after * up**3


def held(v: np.ndarray, share: float) -> np.ndarray:
    return held_direction(TIME, v, SLOW, blurred_sign(v, SLOW), share)


@pytest.mark.parametrize("share", [0.3, 1.0])
@pytest.mark.parametrize("start", [-1.0, 1.0])
def test_a_stop_keeps_its_share_of_the_direction_before(start, share) -> None:
    v = start * stop_and_go(1.0)
    np.testing.assert_allclose(held(v, share)[v == 0.0], share * start)


def test_friction_without_memory_is_the_sign_of_the_speed() -> None:
    v = stop_and_go(-1.0)
    np.testing.assert_array_equal(held(v, 0.0), blurred_sign(v, SLOW))


@pytest.mark.parametrize("share", [0.3, 1.0])
def test_what_is_kept_gives_way_as_the_next_motion_begins(share) -> None:
    v = stop_and_go(-1.0)
    kept = held(v, share)
    leaving = resting(TIME, v, SLOW) & (v < 0.0)
    assert np.count_nonzero(leaving) > 5
    assert np.all(np.diff(kept[leaving]) < 0.0)
    assert kept[leaving][-1] < 0.0  # friction of the new direction, before the joint is fast
    assert np.all(np.abs(kept) <= 1.0)


def test_before_the_first_motion_nothing_is_kept() -> None:
    v = np.where(TIME < 1.0, 0.0, 1.0)
    assert not np.any(held(v, 1.0)[TIME < 1.0])
