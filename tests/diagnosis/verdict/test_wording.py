"""Shares are written as a reader would say them."""

from __future__ import annotations

import pytest

from lagnet.diagnosis.verdict.verdict import NamedParameter
from lagnet.diagnosis.verdict.wording import percent, values


@pytest.mark.parametrize(
    ("share", "words"),
    [(2.5, "250 %"), (0.456, "46 %"), (0.0123, "1.2 %"), (0.00034, "0.034 %"), (3e-7, "less than 0.01 %")],
)
def test_a_share_is_a_percentage_without_a_power_of_ten(share: float, words: str) -> None:
    assert percent(share) == words


def test_a_sentence_tells_what_the_recordings_determine() -> None:
    open_, told = NamedParameter("dm", 1.5, "kg", (-2e6, 2e6)), NamedParameter("dmcx", 0.25, "kg m", (0.2, 0.3))
    assert values([open_, told]) == "dmcx = 0.25 kg m"
    assert values([open_]) == "dm = 1.5 kg"
