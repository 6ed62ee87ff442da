"""The usual step of a clock and rows spread over a table, each written once."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lagnet.recordings.sampling import is_even, median_step, spread_rows


def test_gaps_and_jitter_do_not_change_the_usual_step() -> None:
    time = np.concatenate([0.01 * np.arange(50), 9.0 + 0.01 * np.arange(50)])
    time[10] += 0.004
    assert median_step(time) == pytest.approx(0.01)


def test_a_single_sample_has_a_step_of_a_second() -> None:
    assert median_step(np.array([3.0])) == 1.0


@given(st.integers(1, 3000), st.integers(1, 500))
def test_rows_are_spread_from_the_first_to_the_last(n: int, most: int) -> None:
    rows = spread_rows(n, most)
    assert rows.size == min(n, most)
    assert rows[0] == 0
    assert most == 1 or rows[-1] == n - 1
    if rows.size > 1:
        steps = np.diff(rows)
        assert steps.max() - steps.min() <= 1


def test_no_row_of_an_empty_table_is_taken() -> None:
    assert spread_rows(0, 5).size == 0


@pytest.mark.parametrize(("jitter", "even"), [(0.0, True), (1e-9, True), (1e-3, False)])
def test_a_clock_is_even_but_for_rounding(jitter: float, even: bool) -> None:
    time = 5.0 + 0.01 * np.arange(50)
    time[20] += 0.01 * jitter
    assert is_even(time) == even
