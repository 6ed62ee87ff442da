"""The heights of a surface that motion allows: the lowest cost, and what is little above it."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.motion.surface.profile import RISE, Profile


def of_heights(heights: list[float], costs: list[float]) -> Profile:
    x = np.zeros((len(heights), 6))
    x[:, 3], x[:, 0] = heights, -np.array(heights)
    return Profile(x, np.array(costs))


def test_ends_lie_where_the_cost_has_risen_by_its_share():
    low, high = of_heights([-1.0, 0.0, 1.0, 2.0], [3.0, 2.0, 2.1, 4.0]).ends()
    assert low[3] == pytest.approx(-2.0 * RISE)
    assert high[3] == pytest.approx(1.0 + (2.0 * (1.0 + RISE) - 2.1) / 1.9)
    assert (low[0], high[0]) == (-high[3], -low[3])


def test_the_best_need_not_be_where_the_walk_began_and_ends_stay_at_a_hill_between():
    profile = of_heights([0.0, 1.0, 2.0, 3.0], [2.0, 5.0, 1.9, 1.95])
    assert profile.best[3] == 2.0
    low, high = profile.ends()
    assert 1.0 < low[3] < 2.0
    assert high[3] == 3.0
