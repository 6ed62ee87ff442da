"""The corrected model of one diagnosis is the nominal model of the next: friction first, then the payload."""

from __future__ import annotations

import numpy as np
import pytest

import lagnet
from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.writing import write_diagnosis

pytestmark = pytest.mark.slow

SHARP = 1e-3  # [rad/s]


def test_what_was_calibrated_on_a_free_arm_is_not_named_again_on_a_loaded_one(plant, arm, at, names, tmp_path) -> None:
    friction = [
        at(0, lambda q, v, a, t: 3.0 * v + 2.0 * np.tanh(v / SHARP)),
        at(1, lambda q, v, a, t: 4.0 * v),
        at(2, lambda q, v, a, t: 1.5 * np.tanh(v / SHARP)),
    ]
    free = plant(*friction)
    calibration = diagnose([free.record(1), free.record(2)], arm, [free.record(3)])
    assert {("viscous_friction", arm.joints[1]), ("coulomb_friction", arm.joints[2])} <= names(calibration)
    write_diagnosis(calibration, tmp_path / "free")

    nominal = lagnet.load_robot(tmp_path / "free")
    loaded = plant(*friction, robot=arm.with_payload(1.5, np.array([0.04, 0.02, 0.1]), 0.005 * np.eye(3)))
    second = diagnose([loaded.record(4), loaded.record(5)], nominal, [loaded.record(6)])
    assert names(second) == {("payload", None)}
    assert second.effects[0].value("m") == pytest.approx(1.5, rel=0.05)
    assert second.verdict.nominal["kind"] == "corrected"

    write_diagnosis(second, tmp_path / "loaded")
    both = lagnet.load_robot(tmp_path / "loaded")
    unseen = loaded.record(7)
    time, q = unseen.time, unseen.q
    v, a = np.gradient(q, time, axis=0), np.zeros_like(q)
    kept = both.inverse_dynamics(q, v, a) - second.corrected.inverse_dynamics(q, v, a)
    np.testing.assert_allclose(kept, 0.0, atol=1e-8 * np.abs(unseen.tau).max())


def test_a_free_arm_held_against_its_own_calibration_has_nothing_left(plant, arm, at) -> None:
    free = plant(at(1, lambda q, v, a, t: 4.0 * v))
    corrected = diagnose([free.record(8)], arm, [free.record(9)]).corrected
    again = diagnose([free.record(10)], corrected, [free.record(11)])
    assert again.effects == ()
    assert not again.verdict.found


def test_what_a_calibration_left_open_is_no_news_of_the_next_recordings(plant, arm, at, names) -> None:
    odd = at(1, lambda q, v, a, t: 3.0 * np.tanh(4.0 * q) * np.cos(9.0 * v))
    first = plant(odd)
    calibration = diagnose([first.record(1), first.record(2)], arm, [first.record(3)])
    assert calibration.corrected.left is not None
    assert calibration.corrected.left[1] > 5.0 * calibration.corrected.left[0]
    later = plant(odd, at(1, lambda q, v, a, t: 0.4 * q), at(0, lambda q, v, a, t: 3.0 * v))
    second = diagnose([later.record(4), later.record(5)], calibration.corrected, [later.record(6)])
    assert names(second) == {("viscous_friction", arm.joints[0])}


def test_an_error_that_the_nominal_model_is_known_to_have_hides_what_is_smaller(plant, arm, at, names) -> None:
    real = plant(at(1, lambda q, v, a, t: 0.4 * v))
    recordings = [real.record(1), real.record(2)], arm, [real.record(3)]
    assert names(diagnose(*recordings)) == {("viscous_friction", arm.joints[1])}
    assert diagnose(*recordings, nominal_error=np.full(3, 2.0)).effects == ()
