"""Noise of the torque sensor is not called elasticity."""

from __future__ import annotations

from types import SimpleNamespace
from typing import cast

import pytest

import lagnet.diagnosis.rules.measured_torque_leakage as leakage
from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.catalogue import RULES
from lagnet.diagnosis.rules.measured_torque_leakage import MeasuredTorqueLeakage
from lagnet.diagnosis.settings import DecisionLimits
from lagnet.rigid_body.robot import load_description


@pytest.fixture(scope="module")
def ur10():
    return load_description("ur10")


@pytest.mark.parametrize("seed", [2, 4])
def test_one_joint_that_moves_alone_and_lacks_nothing_gets_no_name(plant, ur10, seed: int) -> None:
    real, rest = plant(robot=ur10), range(1, 6)
    result = diagnose([real.record(seed, hold=rest)], ur10, [real.record(seed + 50, hold=rest)])
    assert result.effects == ()


@pytest.mark.slow
def test_the_noise_would_have_been_named_otherwise(plant, ur10) -> None:
    """Shows that the test above can fail: without the rule, the second derivative of the noise is taken for bending."""
    others = [r for r in RULES if r.name != MeasuredTorqueLeakage.name]
    real, rest = plant(robot=ur10), range(1, 6)
    result = diagnose([real.record(4, hold=rest)], ur10, [real.record(54, hold=rest)], rules=others)
    assert "joint_elasticity" in {e.effect for e in result.effects}


@pytest.mark.parametrize(("left_blind", "idle"), [(0.93, True), (0.2, False)])
def test_what_explains_only_torque_that_it_was_shown_is_idle(monkeypatch, left_blind: float, idle: bool) -> None:
    """A hum is nine tenths explained by its own second derivative, and by no prediction of it."""

    def error(problem, segments, effects, measured_torque=False):
        return 1.0 if not effects else (0.1 if measured_torque else left_blind)

    monkeypatch.setattr(leakage, "predicted_error", error)
    hypothesis = SimpleNamespace(effect="joint_elasticity", joint=0)
    shared = {
        "problem": None,
        "segments": lambda part: (),
        "library": SimpleNamespace(hypotheses=[hypothesis]),
    }
    straight = SimpleNamespace(**shared, indices=(), effects=())
    bent = SimpleNamespace(
        limits=DecisionLimits(), **shared, indices=(0,), effects=("elasticity",), without=lambda index: straight
    )
    assert bool(MeasuredTorqueLeakage().rejected(cast(Candidate, bent))) == idle
