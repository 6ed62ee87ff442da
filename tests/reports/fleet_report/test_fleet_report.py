"""The page of a fleet: what it says, that it is drawn without network, and that it holds foreign words as words."""

from __future__ import annotations

import json
import re

import pytest
from tests.reports.fleet_report.fleets import synthetic_fleet

from lagnet.reports.contents.fleet import Fleet, FleetNotFollowed
from lagnet.reports.fleet_report import write_fleet_report
from lagnet.reports.sections.fleet_headline import words_of


def data_of(text: str) -> dict:
    return json.loads(re.search(r'id="fleet">(.*?)</script>', text, re.DOTALL).group(1))


def test_page_tells_what_changed(tmp_path):
    fleet = synthetic_fleet(21, 12)
    text = write_fleet_report(fleet, tmp_path / "report.html").read_text()
    assert "3 robots of 21 changed." in text
    found = data_of(text)
    assert len(found["robots"]) == 21
    assert {fleet.robots[e["robot"]].name for e in found["events"] if e["recent"]} == {"arm_000"}
    assert found["robots"][3]["errors"] == {"1": "the file is empty"}


def test_a_calm_fleet_is_told_as_such(tmp_path):
    fleet = synthetic_fleet(5, 8)
    calm = Fleet([r for r in fleet.robots if r.name == "arm_001"], [])
    assert "No robot changed" in write_fleet_report(calm, tmp_path / "report.html").read_text()


def test_a_change_in_words():
    event = synthetic_fleet(1, 12).events[0]
    assert words_of(event) == "Coulomb friction (Fc) at elbow: +20 % (+18 to +22 %), at once on 2026-02-07"


def test_a_change_within_a_day_is_told_with_its_time():
    event = synthetic_fleet(1, 12, days=1.0 / 24.0).events[0]
    assert words_of(event).endswith("at once on 2026-01-05 11:00")


def test_an_empty_fleet_has_a_page(tmp_path):
    assert "0 robots" in write_fleet_report(Fleet([], []), tmp_path / "report.html").read_text()


@pytest.mark.browser
def test_page_is_drawn_without_network(tmp_path, browse):
    hostile = "</script><img src=x onerror=alert(1)>"
    seen = browse(write_fleet_report(synthetic_fleet(60, 12, prefix=hostile), tmp_path / "report.html"))
    assert seen.console == ()
    assert seen.requests == ()
    assert "60 of 60 robots" in seen.text
    assert seen.dom.count('class="fleet-plot"') == 7  # six parameters and temperature
    assert "<img" not in seen.dom
    assert 'href="diagnoses/' in seen.dom


@pytest.mark.browser
def test_recordings_of_one_day_are_told_apart_by_their_time(tmp_path, browse):
    seen = browse(write_fleet_report(synthetic_fleet(1, 12, days=1.0 / 24.0), tmp_path / "report.html"))
    assert "2026-01-05 11:00" in seen.text
    assert re.search(r'text-anchor="end">2026-01-05 11:00<', seen.dom)
    assert re.search(r'text-anchor="start">2026-01-05<', seen.dom)


def test_page_tells_what_is_named_and_not_followed(tmp_path):
    fleet = synthetic_fleet(2, 4)
    assert "Named and not followed" not in write_fleet_report(fleet, tmp_path / "report.html").read_text()
    left_out = [FleetNotFollowed("arm_000", "elbow", "command_delay", 3, 4, "2 of 4 recordings <cannot> tell")] * 201
    text = write_fleet_report(Fleet(fleet.robots, fleet.events, left_out), tmp_path / "report.html").read_text()
    assert "Named and not followed" in text
    assert "command delay" in text
    assert "3 of 4" in text
    assert "2 of 4 recordings &lt;cannot&gt; tell" in text
    assert "and 1 more, in not_followed.parquet" in text
