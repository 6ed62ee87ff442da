"""Intervals know of a law whose form is not quite the plant's, and hardly widen where it is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.estimation.intervals.data_subsets import parts_of, travel
from lagnet.diagnosis.estimation.intervals.misspecification import misspecification_errors
from lagnet.diagnosis.estimation.refit import refit
from lagnet.models.corrected.model import NamedEffect

JOINT = 1


def fitted(arm, real, *effects: NamedEffect):
    """Effects refitted to a recording of a plant, their half-widths, and what the error of form adds to them."""
    posed = pose(arm, real.record(1), real.record(2))
    result = refit(posed.problem, effects, posed.noise)
    errors = misspecification_errors(posed.problem, result.effects, posed.noise)
    halves = [{k: 0.5 * (b - a) for k, (a, b) in i.items()} for i in result.intervals]
    return result.effects, halves, errors


def test_a_law_of_the_right_form_hardly_widens(plant, arm, at) -> None:
    real = plant(at(JOINT, lambda q, v, a, t: 4.0 * v + 3.0 * a))
    guesses = (NamedEffect("viscous_friction", JOINT, {"Fv": 3.0}), NamedEffect("rotor_inertia", JOINT, {"Ia": 2.0}))
    _, halves, errors = fitted(arm, real, *guesses)
    for half, error in zip(halves, errors, strict=True):
        for name in half:
            assert np.hypot(half[name], error[name]) < 1.5 * half[name], (name, half, error)


def test_what_is_wrong_at_one_joint_leaves_another_alone(plant, arm, at) -> None:
    real = plant(
        at(0, lambda q, v, a, t: 40.0 * np.sign(v) * np.abs(v) ** 0.8), at(2, lambda q, v, a, t: 9.0 * (q - 0.3))
    )
    guesses = (
        NamedEffect("viscous_friction", 0, {"Fv": 30.0}),
        NamedEffect("joint_spring", 2, {"k": 8.0, "q0": 0.0}),
    )
    _, halves, errors = fitted(arm, real, *guesses)
    assert errors[0]["Fv"] > 2.0 * halves[0]["Fv"]
    assert errors[1]["k"] < halves[1]["k"]


def test_a_late_signal_widens_what_goes_with_speed(plant, arm, at) -> None:
    real = plant(at(JOINT, lambda q, v, a, t: 4.0 * v))
    posed = pose(arm, real.record(1), real.record(2))
    guess = NamedEffect("viscous_friction", JOINT, {"Fv": 4.0})

    def error_with(lag: float) -> float:
        late = tuple(replace(p, tau=p.tau - lag * np.gradient(p.tau, p.time, axis=0)) for p in posed.problem.fit)
        problem = replace(posed.problem, fit=late)
        result = refit(problem, (guess,), posed.noise)
        return misspecification_errors(problem, result.effects, posed.noise)[0]["Fv"]

    assert error_with(0.01) > 3.0 * error_with(0.0) + 0.01


@pytest.mark.slow
def test_the_verdict_holds_the_wider_interval(plant, arm, at, monkeypatch) -> None:
    real = plant(at(JOINT, lambda q, v, a, t: 4.0 * np.sign(v) * np.abs(v) ** 0.9))
    recordings = [real.record(1)], arm, [real.record(2)]
    wide = diagnose(*recordings)
    monkeypatch.setattr("lagnet.diagnosis.diagnose.with_misspecification", lambda state: state)
    narrow = diagnose(*recordings)
    assert [(e.effect, e.joint) for e in wide.effects] == [(e.effect, e.joint) for e in narrow.effects]
    pairs = [
        pair
        for both in zip(wide.effects, narrow.effects, strict=True)
        for pair in zip(*(e.parameters for e in both), strict=True)
    ]
    assert all(w.value == n.value and np.ptp(w.ci95) >= np.ptp(n.ci95) for w, n in pairs)
    assert any(np.ptp(w.ci95) > 1.5 * np.ptp(n.ci95) for w, n in pairs)


def test_halves_of_a_joint_share_no_sample_and_leave_none_out(plant, arm) -> None:
    posed = pose(arm, plant().record(1), plant().record(2))
    parts = list(parts_of(posed.problem, posed.problem.fit, (NamedEffect("viscous_friction", JOINT, {"Fv": 1.0}),)))
    assert len(parts) == 8  # one recording, no effect that reaches others: two halves by each of four signals
    for one, other in zip(parts[::2], parts[1::2], strict=True):
        for a, b in zip(one.rows, other.rows, strict=True):
            assert np.all(a != b)
            assert 0.4 < a.mean() < 0.6


def test_recordings_and_joints_are_left_out_in_turn(plant, arm) -> None:
    posed = pose(arm, plant().record(1), plant().record(2))
    pieces = (*posed.problem.fit, *(replace(p, recording=1) for p in posed.problem.fit))
    effects = (NamedEffect("torque_offset", 0, {"b": 1.0}), NamedEffect("encoder_offset", JOINT, {"delta": 0.1}))
    parts = list(parts_of(posed.problem, pieces, effects))
    assert len(parts) == 2 + arm.n_dof + 2 * 8
    for part in parts[:2]:
        assert sorted(float(rows.mean()) for rows in part.rows) == [0.0, 1.0]
        assert part.speaks_for.all()
    for joint, part in enumerate(parts[2 : 2 + arm.n_dof]):
        assert not part.rows[0][:, joint].any()
        assert part.rows[0].mean() == pytest.approx(1 - 1 / arm.n_dof)
        assert part.speaks_for.tolist() == [False, True]


def test_travel_starts_anew_at_each_reversal_and_not_at_noise() -> None:
    time = np.linspace(0.0, 3.0, 3001)
    q, v = np.abs(time - 1.0), np.where(time < 1.0, -1.0, 1.0)
    v[2000:2003] = -1e-3
    distance = travel(q, v, 1e-2)
    np.testing.assert_allclose(distance, np.where(time < 1.0, time, time - 1.0), atol=2e-3)
