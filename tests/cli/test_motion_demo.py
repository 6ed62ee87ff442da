"""The demo of the motion route finds what it hid, from commands and positions alone."""

from __future__ import annotations

import json

import pytest

from lagnet.cli import main as entry
from lagnet.cli.demo import command
from lagnet.errors import LagnetError


@pytest.mark.slow
def test_what_the_demo_hides_is_found_without_a_torque(tmp_path, capsys):
    assert entry.main(["demo", "--route", "motion", "--seed", "4", "--out", str(tmp_path)]) == 0
    told = capsys.readouterr().out
    assert told.count(": found;") == 2
    assert "not hidden" not in told
    verdict = json.loads((tmp_path / "verdict.json").read_text(encoding="utf-8"))
    assert verdict["route"] == "motion"
    assert (tmp_path / "report.html").is_file()
    header = (tmp_path / "recordings" / "motion_0.csv").read_text(encoding="utf-8").splitlines()[0]
    assert "command_0" in header
    assert "tau" not in header


def test_the_demo_refuses_a_route_that_there_is_not(tmp_path):
    with pytest.raises(LagnetError, match="unknown route 'moton'"):
        command(tmp_path, 4, "moton")
    assert not list(tmp_path.iterdir())
