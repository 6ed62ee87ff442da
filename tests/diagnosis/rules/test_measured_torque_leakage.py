"""Noise and hum of the torque sensor are not called elasticity."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

import lagnet.diagnosis.rules.measured_torque_leakage as leakage
from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.catalogue import RULES
from lagnet.diagnosis.rules.measured_torque_leakage import MeasuredTorqueLeakage
from lagnet.diagnosis.rules.periodic_disturbance import PeriodicDisturbance
from lagnet.diagnosis.settings import DecisionLimits
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.robot import load_description

HUM, SHARE = 5.0, 0.05  # [Hz], of the scatter of the joint's torque


@pytest.fixture(scope="module")
def ur10():
    return load_description("ur10")


@pytest.mark.parametrize("seed", [2, 4])
def test_one_joint_that_moves_alone_and_lacks_nothing_gets_no_name(plant, ur10, seed: int) -> None:
    real, rest = plant(robot=ur10), range(1, 6)
    result = diagnose([real.record(seed, hold=rest)], ur10, [real.record(seed + 50, hold=rest)])
    assert result.effects == ()


@pytest.fixture(scope="module")
def humming(plant, ur10):
    """One joint that moves alone, with a hum of 5 Hz on its torque, whose second derivative is the hum again."""
    real, rest = plant(robot=ur10), range(1, 6)

    def record(seed: int) -> Recording:
        found = real.record(seed, hold=rest)
        phase = 2.0 * np.pi * HUM * found.time + seed + 2.0 * np.sin(0.7 * found.time)
        tau = found.tau.copy()
        tau[:, 0] += SHARE * tau[:, 0].std() * np.sin(phase)
        return replace(found, tau=tau)

    return [record(4)], [record(54)]


BOTH = {MeasuredTorqueLeakage.name, PeriodicDisturbance.name}


@pytest.mark.slow
@pytest.mark.parametrize("without", [set(), {PeriodicDisturbance.name}, BOTH], ids=["all", "one gone", "both gone"])
def test_a_hum_is_called_elasticity_where_neither_rule_rejects_it(humming, ur10, without: set[str]) -> None:
    fitted, held_out = humming
    rules = [r for r in RULES if r.name not in without]
    named = {e.effect for e in diagnose(fitted, ur10, held_out, rules=rules).effects}
    assert ("joint_elasticity" in named) == (without == BOTH)


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
