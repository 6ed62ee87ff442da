"""A cause that is put into a MuJoCo plant is named, with its size, and nothing is named where nothing is hidden."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

import pytest

from lagnet.diagnosis.motion.diagnose import MotionDiagnosis, diagnose_motion
from lagnet.diagnosis.verdict.verdict import EffectFound
from lagnet.rigid_body.robot import load_description

PERCENT = 0.05  # what the encoder's step and MuJoCo's nearly rigid friction leave of a parameter


def diagnosed(pendulum: ModuleType, nominal: Path, tmp_path: Path, plant: dict, signal: dict) -> MotionDiagnosis:
    real = pendulum.write_model(tmp_path / "real.xml", **plant)
    fit = [pendulum.record(real, 40.0, seed, **signal) for seed in (1, 2)]
    return diagnose_motion(fit, load_description(nominal), [pendulum.record(real, 20.0, 3, **signal)])


def size_of(effect: EffectFound, parameter: str, kp: float) -> float:
    """A parameter, or its ratio to kp times kp, where the verdict says that no load sets the scale of torques."""
    values = {p.name: p.value for p in effect.parameters}
    return values[parameter] if parameter in values else kp * values[f"{parameter}/kp"]


@pytest.mark.parametrize(
    ("effect", "parameter", "value", "plant", "signal"),
    [
        pytest.param("coulomb_friction", "Fc", 0.12, {"friction": 0.12}, {}, marks=pytest.mark.slow),
        pytest.param("gain_error", "kp", 5.0, {"kp": 5.0}, {}, marks=pytest.mark.slow),
        ("dead_band", "b", 0.05, {}, {"dead_band": 0.05}),
        pytest.param("rotor_inertia", "Ia", 0.04, {"rotor": 0.04}, {}, marks=pytest.mark.slow),
        pytest.param("command_delay", "T", 0.04, {}, {"delay": 40}, marks=pytest.mark.slow),
    ],
)
def test_a_hidden_cause_is_named_with_its_size(pendulum, nominal, tmp_path, effect, parameter, value, plant, signal):
    found = diagnosed(pendulum, nominal, tmp_path, plant, signal)
    assert found.effects[0].effect == effect
    assert size_of(found.effects[0], parameter, pendulum.NOMINAL["kp"]) == pytest.approx(value, rel=PERCENT)
    assert [e.effect for e in found.effects] == [effect]
    errors = found.verdict.errors[0]
    assert errors.rmse_corrected < 0.3 * errors.rmse_nominal


@pytest.mark.slow
def test_nothing_is_named_where_nothing_is_hidden(pendulum, nominal, tmp_path):
    found = diagnosed(pendulum, nominal, tmp_path, {}, {})
    assert found.effects == ()
    assert not found.verdict.found


@pytest.mark.slow
@pytest.mark.parametrize("torque", [0.06, 0.1])
def test_a_break_away_torque_is_named_and_its_interval_holds_it(pendulum, nominal, tmp_path, torque):
    found = diagnosed(pendulum, nominal, tmp_path, {}, {"break_away": torque})
    assert [e.effect for e in found.effects] == ["static_friction"]
    (told,) = found.effects[0].parameters
    low, high = told.ci95
    assert low <= torque <= high < 3.0 * torque
