"""Fewer samples, the same peaks; motions beside one another, never joined by a line."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from lagnet.diagnosis.verdict.report_data import HeldOutSeries
from lagnet.reports.figures.decimation import (
    PAGE_POINTS,
    broken,
    chosen_samples,
    end_to_end,
    extremes,
    scattered,
    series_budget,
)


@given(st.integers(1, 5000), st.integers(2, 400), st.integers(0, 9))
def test_extremes_keep_the_peaks_within_the_limit(n, limit, seed):
    values = np.random.default_rng(seed).standard_normal(n)
    chosen = extremes(values, limit)
    assert len(chosen) <= limit or len(chosen) == n <= limit
    assert np.all(np.diff(chosen) > 0)
    assert values[chosen].min() == values.min()
    assert values[chosen].max() == values.max()


@given(st.integers(1, 5000), st.integers(1, 400))
def test_scattered_samples_are_distinct_and_few(n, limit):
    chosen = scattered(n, limit)
    assert len(chosen) == min(n, limit)
    assert len(np.unique(chosen)) == len(chosen)


def test_all_joints_together_keep_to_the_page():
    assert all(n * series_budget(n) <= PAGE_POINTS for n in range(6, 40))


def two_motions(second_start: float) -> HeldOutSeries:
    time = np.r_[np.arange(50) / 10, second_start + np.arange(30) / 10]
    torque = np.arange(80.0)
    return HeldOutSeries(time, torque, torque, torque, ((0, 50), (50, 80)))


def test_recordings_that_start_anew_are_laid_end_to_end():
    time, starts, moved = end_to_end(two_motions(0.0))
    assert moved
    assert np.all(np.diff(time) > 0)
    assert starts[1] > time[49]
    assert np.allclose(np.diff(time[50:]), 0.1)


def test_one_clock_is_kept():
    series = two_motions(9.0)
    time, _, moved = end_to_end(series)
    assert not moved
    assert np.array_equal(time, series.time)


def test_no_line_joins_two_motions():
    series = two_motions(9.0)
    drawn = broken(series.measured, series, chosen_samples(series, 1000))
    assert len(drawn) == 81
    assert np.flatnonzero(np.isnan(drawn)).tolist() == [50]
