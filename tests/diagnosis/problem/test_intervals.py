"""Samples of event intervals are no evidence of what persists, unless the intervals are the whole recording."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.problem.intervals import EventInterval, lasting
from lagnet.diagnosis.problem.problem import pose_problem
from lagnet.recordings.conditioning.condition import condition


@pytest.fixture(scope="module")
def problem(plant, arm):
    real = plant()
    fit = condition([real.record(1)])
    return pose_problem(arm, fit, condition([real.record(2)], fit.bandwidth))


def valid(pieces) -> int:
    return int(np.sum([p.counts.sum() for p in pieces]))


def test_a_short_event_is_left_out_of_what_persists(problem) -> None:
    rest = lasting(problem, [EventInterval(0, False, 5.0, 9.0, 100.0)])
    assert 0 < valid(rest.fit) < valid(problem.fit)
    assert valid(rest.holdout) == valid(problem.holdout)


@pytest.mark.parametrize("held_out", [False, True])
def test_an_event_that_is_the_recording_is_no_exception(problem, held_out: bool) -> None:
    """Else nothing would be left to identify a correction from: a load that was mounted otherwise, for instance."""
    assert lasting(problem, [EventInterval(0, held_out, 0.0, 24.0, 100.0)]) is problem
