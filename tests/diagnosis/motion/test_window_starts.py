"""Windows of rollouts start where the measured state is surest: at rest, or in even motion."""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.motion.problem import REACH, surest_edges


def test_edges_move_to_rest_and_to_even_motion():
    speed = np.concatenate([np.sin(np.arange(90) / 5.0), np.zeros(20), np.cos(np.arange(90) / 5.0)])
    edges = surest_edges(speed, 2)
    assert edges[0] == 0
    assert edges[-1] == 199
    assert speed[edges[1]] == 0.0
    even = np.concatenate([np.arange(60) ** 2 / 3600.0, np.ones(30), 1.0 + np.arange(60) ** 2 / 3600.0])
    assert 60 < surest_edges(even, 2)[1] < 90


def test_edges_stay_in_their_reach_and_of_equal_ones_the_nearest_is_taken():
    assert list(surest_edges(np.ones(101), 4)) == [0, 25, 50, 75, 100]
    jerky = np.random.default_rng(0).normal(size=(401, 2))
    edges = surest_edges(jerky, 8)
    assert np.all(np.abs(edges - np.linspace(0, 400, 9)) <= REACH * 50)
    assert np.all(np.diff(edges) > 0)
