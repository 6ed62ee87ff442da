"""The study of the fleet's page measures a page: a paint, an answer to each word, all robots back in the end."""

from __future__ import annotations

import pytest
from validation.fleet.page import WORDS, told_of


@pytest.mark.browser
def test_a_page_tells_its_times(chromium: str) -> None:
    told = told_of(30, 5)
    assert told["first_paint_ms"] > 0.0
    assert len(told["filter_ms"]) == len(WORDS)
    assert min(told["filter_ms"]) > 0.0
    assert told["shown"] == "30 of 30 robots"
