"""Shares are written as a reader would say them."""

from __future__ import annotations

import pytest

from lagnet.percent import percent


@pytest.mark.parametrize(
    ("share", "words"),
    [
        (2.5, "250 %"),
        (0.456, "46 %"),
        (0.0123, "1.2 %"),
        (0.00034, "0.034 %"),
        (3e-7, "less than 0.01 %"),
        (-0.03, "-3 %"),
    ],
)
def test_a_share_is_a_percentage_without_a_power_of_ten(share: float, words: str) -> None:
    assert percent(share) == words


@pytest.mark.parametrize(("share", "words"), [(0.1234, "12.3 %"), (1.234, "123 %"), (43.21, "4321 %")])
def test_more_digits_where_they_are_asked_for(share: float, words: str) -> None:
    assert percent(share, 3) == words
