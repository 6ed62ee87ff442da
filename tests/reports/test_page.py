"""A page draws its plots, fetches nothing, and shows foreign words as words."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from markupsafe import Markup

from lagnet.reports.figures.figure import Figure, axis, colour, names_axis, packed, plain
from lagnet.reports.page import Section, json_for_script, page, write_page

HOSTILE = "</script><script>document.title='owned'</script><img src=x onerror=alert(1)>"


def section_with_plot(name: str) -> Section:
    traces = [
        {"type": "scatter", "x": packed(np.arange(9)), "y": packed(np.ones(9)), "name": plain(name)},
        {"type": "bar", "x": [plain(name)], "y": [1.0], "marker": {"color": colour("accent")}, "xaxis": "x2"},
    ]
    layout = {
        "xaxis": {**axis("time", "s"), "domain": [0, 0.4]},
        "yaxis": axis("torque", "N m"),
        "xaxis2": names_axis(domain=[0.6, 1]),
    }
    figure = Figure("one", traces, f"torque of {name}", layout)
    return Section("part", name, Markup('<div class="plot" data-figure="one"></div>'), (figure,))


def test_hostile_names_stay_words(tmp_path):
    text = page(HOSTILE, HOSTILE, [section_with_plot(HOSTILE)])
    assert "<script>document" not in text
    assert "<img" not in text


def test_data_survive_the_script_tag():
    name = HOSTILE + "\u2028&"
    content = {"name": name, "value": math.nan, "row": (1.0, -math.inf), "array": np.array([1.0, np.nan])}
    text = str(json_for_script(content))
    assert not set("<>&\u2028") & set(text)
    assert json.loads(text) == {"name": name, "value": None, "row": [1.0, None], "array": [1.0, None]}


def test_an_interrupted_write_leaves_the_old_page(tmp_path):
    path = tmp_path / "report.html"
    path.write_text("old")
    with pytest.raises(TypeError):
        write_page(path, "t", "s", [Section("k", "K", Markup(""), (Figure("f", [{"x": object()}], "d"),))])
    assert [entry.name for entry in tmp_path.iterdir()] == ["report.html"]
    assert path.read_text() == "old"


@pytest.mark.browser
def test_page_is_drawn_without_network(tmp_path, browse):
    path = write_page(tmp_path / "report.html", "A title", "A line", [section_with_plot(HOSTILE)])
    seen = browse(path)
    assert seen.console == ()
    assert seen.requests == ()
    assert seen.drawn == 1
    assert "<title>A title</title>" in seen.dom


@pytest.mark.browser
def test_the_browser_check_notices_errors_and_requests(tmp_path, browse):
    """The checks above can fail: a page with a broken script and a foreign image is caught on both counts."""
    path = tmp_path / "bad.html"
    path.write_text("<!doctype html><img src='https://example.org/a.png'><script>console.error('broken')</script>")
    seen = browse(path)
    assert any("broken" in line for line in seen.console)
    assert any("example.org" in address for address in seen.requests)
