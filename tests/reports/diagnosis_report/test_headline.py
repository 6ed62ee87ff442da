"""The top of the page speaks of remainders that matter; the table further down holds all."""

from __future__ import annotations

from types import SimpleNamespace

from lagnet.reports.sections import headline


def test_a_remainder_that_the_page_writes_as_nothing_is_not_in_the_headline() -> None:
    left = [
        {"joint": "wrist", "above_noise": True, "share_of_mismatch": 1.0},
        {"joint": "elbow", "above_noise": True, "share_of_mismatch": 0.2},
        {"joint": "base", "above_noise": False, "share_of_mismatch": 0.9},
    ]
    error = {"wrist": 5e-5, "elbow": 0.1, "base": 0.1}
    findings = SimpleNamespace(verdict={"unexplained": left}, fit=lambda joint: {"nmse_nominal": error[joint]})
    assert [entry["joint"] for entry in headline._remainder(findings)] == ["elbow"]
