"""One form of a law in the place of another form and one more effect: the motor's side for the link's and a gain."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.selection.form_exchange import exchange_forms

K = 0.12
PER_LOAD, GAIN = "load_dependent_friction", "torque_gain"


def by_power(driving: float, driven: float):
    """Friction per torque of the link, by whether the motor drives it."""

    def law(q, v, a, load):
        return np.where(load * v > 0, driving, driven) * np.abs(load) * np.tanh(v / 1e-3)

    return law


def efficiency(k: float):
    """Friction of K per torque of the motor."""
    return by_power(k / (1 - k), k / (1 + k))


def told(plant, arm, at, law):
    """Effects and sides in the place of the link's side and a gain, selected together."""
    real = plant(at(1, law))
    posed = pose(arm, real.record(1), real.record(2))
    equations, found = exchange_forms(posed.problem, posed.equations, posed.select({1: [PER_LOAD, GAIN]}))
    selected = (equations.library.hypotheses[i] for i in found.local[1])
    return sorted((h.effect, dict(h.shape).get("side", 0.0)) for h in selected)


def test_friction_per_torque_of_the_motor_takes_the_place_of_a_gain(plant, arm, at) -> None:
    assert told(plant, arm, at, efficiency(K)) == [(PER_LOAD, 1.0)]


@pytest.mark.parametrize(("driving", "driven"), [(0.05, 0.15), (0.2, 0.05)])
def test_a_gain_that_is_no_part_of_it_stays(plant, arm, at, driving: float, driven: float) -> None:
    assert told(plant, arm, at, by_power(driving, driven)) == [(PER_LOAD, 0.0), (GAIN, 0.0)]


def test_what_has_one_form_is_left_as_it_is(plant, arm, at) -> None:
    real = plant(at(1, lambda q, v, a, load: 3.0 * v))
    posed = pose(arm, real.record(1), real.record(2))
    found = posed.select({1: ["viscous_friction", GAIN]})
    assert exchange_forms(posed.problem, posed.equations, found) == (posed.equations, found)


@pytest.mark.parametrize("k", [0.08, K, 0.25, 0.45])
@pytest.mark.parametrize("joint", [0, 1, 2])
def test_friction_per_torque_of_the_motor_is_named_alone(plant, arm, at, k: float, joint: int) -> None:
    real = plant(at(joint, efficiency(k)))
    result = diagnose([real.record(1), real.record(2)], arm, [real.record(3)])
    (found,) = result.effects
    assert (found.effect, found.joint, found.value("side")) == (PER_LOAD, arm.joints[joint], 1.0)
    assert found.value("K") == pytest.approx(k, rel=0.02)
    assert "motor" in found.explanation


def test_viscous_friction_beside_it_keeps_its_name(plant, arm, at) -> None:
    real = plant(at(1, efficiency(K)), at(1, lambda q, v, a, load: 0.03 * plant().usual_torque()[1] * v))
    result = diagnose([real.record(1), real.record(2)], arm, [real.record(3)])
    assert {e.effect for e in result.effects} == {PER_LOAD, "viscous_friction"}


def test_a_gain_beside_friction_per_load_may_be_friction_that_differs_by_power(plant, arm, at) -> None:
    real = plant(at(1, by_power(0.05, 0.15)))
    result = diagnose([real.record(1), real.record(2)], arm, [real.record(3)])
    told = {e.effect: e for e in result.effects}
    assert set(told) == {PER_LOAD, GAIN}
    assert PER_LOAD in told[GAIN].tied_with
    assert not told[PER_LOAD].tied_with
