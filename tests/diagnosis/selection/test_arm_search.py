"""Which effects of the whole arm are searched in full: one a place, those with physical coefficients first."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.selection.arm_search import TRIED, _promising, total_score


@pytest.fixture(scope="module")
def tried(plant, arm, at):
    """What is tried beside nothing on a loaded arm with friction: whether physical, and the place of each."""
    heavy = arm.with_payload(1.5, np.array([0.05, 0.08, 0.15]), 0.006 * np.eye(3))
    real = plant(at(1, lambda q, v, a, body: 4.0 * np.tanh(v / 0.01)), robot=heavy)
    posed = pose(arm, real.record(41), real.record(42))
    bare = posed.select({})
    chosen = _promising(posed.equations, bare)
    physical = [bool(np.isfinite(total_score(posed.equations, (i,), bare))) for i in chosen]
    return physical, [posed.library.hypotheses[i].place for i in chosen]


def test_one_shape_a_place_is_tried(tried) -> None:
    _, places = tried
    assert len(set(places)) == len(places) == TRIED


def test_physical_ones_come_first(tried) -> None:
    physical, places = tried
    assert places[0] == ("payload", None)
    assert physical == sorted(physical, reverse=True)
