"""Odds grow with the square of a lead in standard errors, keep its sign, and end where more would say nothing."""

from __future__ import annotations

import pytest

from lagnet.diagnosis.motion.joint.block_scores import GREATEST_ODDS, log10_odds


def test_odds_are_those_of_a_normal_deviate():
    assert log10_odds(0.0) == 0.0
    assert log10_odds(3.0) == pytest.approx(1.954325, abs=1e-6)  # exp(9/2) = 90.017
    assert log10_odds(-3.0) == -log10_odds(3.0)
    assert log10_odds(1e3) == GREATEST_ODDS == -log10_odds(-1e3)
