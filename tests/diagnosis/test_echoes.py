"""Noise of the torque sensor is not called elasticity."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

import lagnet.diagnosis.echoes as echoes
from lagnet.diagnosis.diagnose import diagnose
from lagnet.rigid_body.robot import load_description


@pytest.fixture(scope="module")
def ur10():
    return load_description("ur10")


@pytest.mark.parametrize("seed", [2, 4])
def test_one_joint_that_moves_alone_and_lacks_nothing_gets_no_name(plant, ur10, seed: int) -> None:
    real, rest = plant(robot=ur10), range(1, 6)
    result = diagnose([real.record(seed, hold=rest)], ur10, [real.record(seed + 50, hold=rest)])
    assert result.effects == ()


def test_the_noise_would_have_been_named_otherwise(plant, ur10, monkeypatch) -> None:
    """Shows that the test above can fail: without the step, the second derivative of the noise is taken for bending."""
    monkeypatch.setattr("lagnet.diagnosis.inquiry.drop_echoes", lambda problem, bench, found, fitted: (found, fitted))
    real, rest = plant(robot=ur10), range(1, 6)
    result = diagnose([real.record(4, hold=rest)], ur10, [real.record(54, hold=rest)])
    assert "joint_elasticity" in {e.effect for e in result.effects}


@pytest.mark.parametrize(("left_blind", "idle"), [(0.93, True), (0.2, False)])
def test_what_explains_only_torque_that_it_was_shown_is_idle(monkeypatch, left_blind: float, idle: bool) -> None:
    """A hum is nine tenths explained by its own second derivative, and by no prediction of it."""

    def error(problem, pieces, effects, shown=False):
        return 1.0 if not effects else (0.1 if shown else left_blind)

    monkeypatch.setattr(echoes, "predicted_error", error)
    bent, straight = SimpleNamespace(effects=("elasticity",)), SimpleNamespace(effects=())
    assert echoes._is_idle(None, (), bent, straight) == idle
