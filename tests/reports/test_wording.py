"""Numbers are rounded as an engineer would write them, and long names break without losing a letter."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from markupsafe import Markup

from lagnet.reports.wording import (
    breakable,
    effect_words,
    file_name,
    interval,
    listed,
    number,
    percent,
    with_interval,
    wrapped,
)


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (0.0, "0"),
        (14.2, "14.2"),
        (-3.16, "−3.16"),
        (0.0034512, "0.00345"),
        (999.99, "1000"),
        (123456.0, "123456"),
        (1.2e-6, "1.20·10⁻⁶"),
        (-1e7, "−1.00·10⁷"),
        (math.nan, "–"),
        (None, "–"),
    ],
)
def test_three_digits(value, words):
    assert number(value) == words


@pytest.mark.parametrize(
    ("share", "words"),
    [(0.0, "0 %"), (0.96, "96 %"), (0.007, "0.70 %"), (1.7, "170 %"), (2e-5, "< 0.01 %"), (None, "–")],
)
def test_percent(share, words):
    assert percent(share) == words


@pytest.mark.parametrize(
    ("value", "low", "high", "words"),
    [
        (14.2, 13.9, 14.5, "14.20 ± 0.30"),
        (203.5, 202.1, 204.9, "203.5 ± 1.4"),
        (-3.16, -3.2, -3.12, "−3.160 ± 0.040"),
        (3.0, 2.0, 5.5, "3.0 (2.0 … 5.5)"),
        (12345.0, 12000.0, 12690.0, "12345 ± 345"),
        (5.0, 5.0, 5.0, "5.00"),
        (1e-8, 0.9e-8, 1.1e-8, "1.00·10⁻⁸ ± 1.0·10⁻⁹"),
        (1.5, -2e6, 2e6, "not determined, taken as 1.50"),
    ],
)
def test_interval_sets_the_digits(value, low, high, words):
    assert with_interval(value, low, high) == words


def test_parameters_that_recordings_leave_open_have_no_interval():
    assert interval((1.2, 1.4)) == "1.200 … 1.400"
    assert interval([-2e6, 2e6]) == "not determined"


@given(st.floats(allow_nan=False, allow_infinity=False, width=32), st.integers(1, 8))
def test_number_keeps_the_value_to_its_digits(value, digits):
    words = number(value, digits).replace("−", "-")
    mantissa, _, exponent = words.partition("·10")
    ordinary = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
    read = float(mantissa) * 10.0 ** int(exponent.translate(ordinary) or 0)
    assert read == pytest.approx(value, rel=0.51 * 10.0 ** (1 - digits), abs=0.0)


@given(st.text("ab_-/ <", max_size=60), st.integers(4, 20))
def test_wrapped_lines_hold_the_whole_name(name, width):
    lines = wrapped(name, width)
    assert "".join(lines).replace(" ", "") == name.replace(" ", "")
    assert all(len(line) <= width for line in lines)


@given(st.text(max_size=60))
def test_breakable_names_lose_nothing(name):
    assert breakable(name).replace(Markup("<wbr>"), "") == Markup.escape(name)


def test_lists_and_names():
    assert [listed([]), listed(["a"]), listed(["a", "b"])] == ["", "a", "a and b"]
    assert listed(["a", "b", "c"]) == "a, b and c"
    assert effect_words("stribeck_friction") == "Stribeck friction"


@pytest.mark.parametrize(
    ("path", "name"),
    [("a/b.csv", "b.csv"), ("C:\\a\\b.csv", "b.csv"), ("folder/", "folder"), ("b", "b"), ("/", "/"), ("", "")],
)
def test_file_name(path, name):
    assert file_name(path) == name
