"""Edges of what acts for a while lie within its recording, or a little beyond."""

from __future__ import annotations

import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.transients.separation import within_recording
from lagnet.models.corrected.named_effects import NamedEffect

LITTLE = 0.1  # [s]
KNOWN = {"t0": (-60.0, 10.0), "t1": (8.9, 9.1), "m": (0.9, 1.1)}


@pytest.fixture(scope="module")
def problem(plant, arm):
    return pose(arm, plant().record(27), plant().record(28)).problem


def test_an_edge_far_before_the_recording_is_where_it_begins(problem) -> None:
    effect, intervals = within_recording(problem, NamedEffect("payload", None, {"m": 1.0}, (-25.0, 9.0), 0), KNOWN)
    start, end = effect.interval
    assert -LITTLE < start <= problem.fit[0].time[0]
    assert end == 9.0
    assert intervals == {**KNOWN, "t0": (start, start)}


def test_edges_inside_are_left_as_they_are(problem) -> None:
    given = NamedEffect("payload", None, {"m": 1.0}, (3.0, 9.0), 0)
    effect, intervals = within_recording(problem, given, KNOWN)
    assert effect == given
    assert intervals == KNOWN
