"""What is put into a plant comes out by its name, at its joint, inside its interval; what is not, does not."""

from __future__ import annotations

import json

import numpy as np
import pytest

from lagnet.diagnosis.diagnose import diagnose

WIDER = 2.5  # half-widths of a 95 % interval: five standard errors, and the tanh of s(v) is not the plant's sign
MEDIAN_ERROR = 0.03  # relative, of one parameter from 24 s with 1 % noise on three joints
SHARP = 1e-3  # [rad/s] over which the plant's dry friction changes sign


def sign(v):
    return np.tanh(v / SHARP)


SINGLE = {
    "viscous_friction": (lambda q, v, a, t: 4.0 * v, {"Fv": 4.0}),
    "coulomb_friction": (lambda q, v, a, t: 2.0 * sign(v), {"Fc": 2.0}),
    "quadratic_drag": (lambda q, v, a, t: 5.0 * v * np.abs(v), {"Fd": 5.0}),
    "rotor_inertia": (lambda q, v, a, t: 3.0 * a, {"Ia": 3.0}),
    "joint_spring": (lambda q, v, a, t: 9.0 * (q - 0.3), {"k": 9.0, "q0": 0.3}),
    "torque_offset": (lambda q, v, a, t: 3.0 + 0.0 * q, {"b": 3.0}),
    "torque_gain": (lambda q, v, a, t: 0.25 * t, {"g": 1.25}),
}


@pytest.mark.parametrize("name", SINGLE)
def test_one_effect_is_named_at_its_joint_with_its_size(name: str, plant, arm, at, names) -> None:
    law, truth = SINGLE[name]
    real = plant(at(1, law))
    result = diagnose([real.record(1)], arm, [real.record(2)])
    assert names(result) == {(name, arm.joints[1])}
    assert result.verdict.found
    for parameter in result.effects[0].parameters:
        true = truth[parameter.name]
        half = 0.5 * (parameter.ci95[1] - parameter.ci95[0])
        assert abs(parameter.value - true) <= max(WIDER * half, 1e-9), (parameter, true)
        assert abs(parameter.value - true) <= MEDIAN_ERROR * max(abs(true), 0.5)
    fit = result.verdict.fit[1]
    assert fit.nmse_named < 0.1 * fit.nmse_nominal
    assert fit.nmse_named < 3.0 * fit.nmse_noise_floor + 1e-4


def test_a_payload_is_named_with_its_mass_and_centre(plant, arm, names) -> None:
    centre, inertia = np.array([0.05, -0.02, 0.1]), 0.004 * np.eye(3)
    real = plant(robot=arm.with_payload(1.2, centre, inertia))
    result = diagnose([real.record(3), real.record(4)], arm, [real.record(5)])
    assert names(result) == {("payload", None)}
    value = result.effects[0].value
    assert value("m") == pytest.approx(1.2, rel=0.05)


def test_two_effects_at_two_joints(plant, arm, at, names) -> None:
    real = plant(at(0, SINGLE["coulomb_friction"][0]), at(2, SINGLE["rotor_inertia"][0]))
    result = diagnose([real.record(6)], arm, [real.record(7)])
    assert names(result) == {("coulomb_friction", arm.joints[0]), ("rotor_inertia", arm.joints[2])}


@pytest.mark.parametrize("seed", range(4))
def test_nothing_left_out_is_nothing_found(seed: int, plant, arm) -> None:
    real = plant()
    result = diagnose([real.record(10 + seed)], arm, [real.record(20 + seed)])
    assert result.effects == ()
    assert not result.verdict.found
    assert not any(u.above_noise for u in result.verdict.unexplained)


def test_a_corrected_model_of_nothing_is_the_nominal_model(plant, arm) -> None:
    result = diagnose([plant().record(31)], arm, [plant().record(32)])
    q = np.zeros((3, 3))
    np.testing.assert_array_equal(result.corrected.inverse_dynamics(q, q, q), arm.inverse_dynamics(q, q, q))


def test_friction_and_offset_are_tied_with_friction_that_differs_by_direction(plant, arm, at) -> None:
    real = plant(at(1, lambda q, v, a, t: np.where(v > 0, 3.0, 1.5) * sign(v)))
    result = diagnose([real.record(33)], arm, [real.record(34)])
    named = {e.effect: e for e in result.effects}
    assert {e.joint for e in result.effects} == {arm.joints[1]}
    assert set(named) in ({"asymmetric_friction"}, {"coulomb_friction", "torque_offset"})
    ties = {name for e in result.effects for name in e.tied_with}
    assert ties & {"asymmetric_friction", "coulomb_friction", "torque_offset"}
    assert all((e.status == "tied") == bool(e.tied_with) for e in result.effects)


def test_a_joint_that_stands_still_is_abstained_from(plant, arm, at, names) -> None:
    real = plant(at(1, SINGLE["viscous_friction"][0]))
    result = diagnose([real.record(35, hold=[2])], arm, [real.record(36, hold=[2])])
    assert all(joint != arm.joints[2] for _, joint in names(result))
    silent = {a.effect: a for a in result.verdict.abstentions if a.joint == arm.joints[2]}
    assert {"viscous_friction", "coulomb_friction", "rotor_inertia", "joint_spring"} <= set(silent)
    assert "does not move" in silent["viscous_friction"].reason
    assert arm.joints[2] in silent["viscous_friction"].record_next


def test_a_joint_that_moves_one_way_says_nothing_of_dry_friction(plant, arm, names) -> None:
    real = plant()
    result = diagnose([real.record(37, one_way=[0])], arm, [real.record(38, one_way=[0])])
    reasons = {a.effect: a.reason for a in result.verdict.abstentions if a.joint == arm.joints[0]}
    for effect in ("coulomb_friction", "asymmetric_friction", "torque_offset"):
        assert "one direction" in reasons[effect]
    assert ("coulomb_friction", arm.joints[0]) not in names(result)


def test_the_same_seed_gives_the_same_words(plant, arm, at) -> None:
    real = plant(at(0, SINGLE["viscous_friction"][0]))
    fit, held = real.record(39), real.record(40)
    first, second = (diagnose([fit], arm, [held], seed=3).to_json() for _ in range(2))
    assert first == second
    assert json.loads(first)["seed"] == 3


def test_without_a_holdout_the_last_fifth_is_held_out(plant, arm, at) -> None:
    real = plant(at(0, SINGLE["viscous_friction"][0]))
    whole = real.record(41, seconds=30.0)
    result = diagnose([whole], arm)
    roles = {r["role"]: r["n_samples"] for r in result.verdict.recordings}
    assert roles == {"fit": 2400, "holdout": 600}
    assert result.holdout_recordings[0].time[0] == whole.time[2400]


def test_where_dry_friction_acts_is_told(plant, arm, at) -> None:
    real = plant(at(1, SINGLE["quadratic_drag"][0]))
    result = diagnose([real.record(42)], arm, [real.record(43)])
    joint = result.verdict.joints[1]
    assert joint.significant
    assert joint.where
    assert any(w["regime"] == "high_speed" and w["lift"] > 1.2 for w in joint.where)
    for w in joint.where:
        assert 0.0 <= w["share_of_residual"] <= 1.0
        assert 0.0 <= w["share_of_time"] <= 1.0


@pytest.mark.slow
def test_an_unknown_that_no_law_fits_is_called_unexplained(plant, arm, at) -> None:
    real = plant(at(1, lambda q, v, a, t: 6.0 * np.tanh(4.0 * q) * np.cos(9.0 * v)))
    result = diagnose([real.record(44, seconds=40.0)], arm, [real.record(45)])
    left = result.verdict.unexplained[1]
    assert left.above_noise
    assert left.share_of_mismatch > 0.05
    assert {"q_1", "v_1"} & set(left.depends_on)
