"""A residual is told where it is, in words that can be checked."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.unexplained.localisation import LEAST_LIFT, locate


@pytest.fixture(scope="module")
def problem(plant, arm):
    return pose(arm, plant().record(81), plant().record(82)).problem


def motion_of(problem, name):
    return np.concatenate([getattr(p, name)[p.keep, 1] for p in problem.fit])


WHERE = {
    "high_speed": lambda p: np.abs(motion_of(p, "v")) > np.quantile(np.abs(motion_of(p, "v")), 0.9),
    "low_speed": lambda p: np.abs(motion_of(p, "v")) < np.quantile(np.abs(motion_of(p, "v")), 0.1),
    "positive_direction": lambda p: motion_of(p, "v") > 0,
    "high_acceleration": lambda p: np.abs(motion_of(p, "a")) > np.quantile(np.abs(motion_of(p, "a")), 0.8),
    "position": lambda p: motion_of(p, "q") > np.quantile(motion_of(p, "q"), 0.85),
    "time_interval": lambda p: np.concatenate([x.time[x.keep] for x in p.fit]) > 20.0,
}


@pytest.mark.parametrize("kind", WHERE)
def test_the_regime_that_holds_the_residual_is_told(problem, kind) -> None:
    residual = np.where(WHERE[kind](problem), 1.0, 0.02)
    told = locate(problem, residual, 1, prismatic=False)
    regime = next(r for r in told if r.regime == kind)
    assert regime.lift > LEAST_LIFT
    assert regime.share_of_residual > 0.5
    assert regime.share_of_residual == pytest.approx(regime.lift * regime.share_of_time)


def test_an_even_residual_is_everywhere(problem) -> None:
    residual = np.ones(motion_of(problem, "v").size)
    assert [r.regime for r in locate(problem, residual, 1, prismatic=False)] == ["everywhere"]


def test_a_nominal_torque_that_is_nought_but_for_rounding_makes_no_regime(problem) -> None:
    rounding = tuple(replace(p, load=1e-17 * p.load) for p in problem.fit)
    heavy = np.concatenate([np.abs(p.load[p.keep, 1]) for p in problem.fit])
    residual = np.where(heavy > np.quantile(heavy, 0.8), 1.0, 0.02)
    told = [r.regime for r in locate(problem, residual, 1, prismatic=False)]
    assert "high_load" in told
    without = locate(replace(problem, fit=rounding), residual, 1, prismatic=False)
    assert "high_load" not in [r.regime for r in without]


def test_no_residual_is_nowhere(problem) -> None:
    assert locate(problem, np.zeros(motion_of(problem, "v").size), 1, prismatic=False) == ()
