"""Friction that grows with the load, on either side of the gear."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.effects.catalogue import effect_named
from lagnet.effects.torque.load_dependent_friction import LINK, MOTOR, SHARP, TRIED, LoadDependentFriction

LAW = LoadDependentFriction()
JOINT = 1
few = pytest.mark.parametrize("k", [0.05, 0.2, 0.6])


@pytest.fixture
def motion(ur5, sweep):
    return sweep(ur5, 3).motion


@few
def test_on_the_motors_side_it_is_proportional_to_the_torque_of_the_motor(motion, k: float) -> None:
    friction = LAW.torque(motion, JOINT, {"K": k, "side": MOTOR})
    motor = motion.load[:, JOINT] + friction
    assert friction == pytest.approx(k * np.abs(motor) * motion.direction(JOINT), rel=1e-9, abs=1e-9)


@few
def test_in_motion_that_is_the_links_side_and_a_gain(motion, k: float) -> None:
    moves = np.abs(motion.v[:, JOINT]) > 20.0 * motion.slow[JOINT]
    gain = effect_named("torque_gain")
    link = LAW.torque(motion, JOINT, {"K": k / (1 - k**2), "side": LINK})
    both = link + gain.torque(motion, JOINT, {"g": 1.0 / (1.0 - k**2)})
    assert moves.sum() > 100
    assert LAW.torque(motion, JOINT, {"K": k, "side": MOTOR})[moves] == pytest.approx(both[moves], rel=1e-6)


@few
def test_friction_by_power_is_what_the_torque_is_in_motion(motion, k: float) -> None:
    values = {"K": k, "side": MOTOR}
    load, moves = motion.load[:, JOINT], np.abs(motion.v[:, JOINT]) > 20.0 * motion.slow[JOINT]
    driving, driven = LAW.by_power(values)
    share = np.where(load * motion.v[:, JOINT] > 0, driving, driven)
    expected = share * np.abs(load) * np.sign(motion.v[:, JOINT])
    assert LAW.torque(motion, JOINT, values)[moves] == pytest.approx(expected[moves], rel=1e-6)
    assert LAW.by_power({"K": k}) == (k, k)


def test_a_gear_that_would_lock_has_finite_friction(motion) -> None:
    assert np.isfinite(LAW.torque(motion, JOINT, {"K": 1.0, "side": MOTOR})).all()
    assert np.isfinite(LAW.by_power({"K": 1.0, "side": MOTOR})).all()


def test_values_of_files_without_a_side_are_of_the_link() -> None:
    assert LAW.with_names_of_today({"K": 0.1}) == {"K": 0.1, "side": LINK}
    assert LAW.with_names_of_today({"K": 0.1, "side": MOTOR}) == {"K": 0.1, "side": MOTOR}


def test_its_formula_says_whose_torque_it_follows() -> None:
    assert "load" in LAW.formula_with({"K": 0.1, "side": LINK})
    assert "motor" in LAW.formula_with({"K": 0.1, "side": MOTOR})
    assert LAW.remark({"K": 0.1, "side": LINK}) == ""
    assert all(words in LAW.remark({"K": 0.2, "side": MOTOR}) for words in ("motor", "25 %", "16.7 %"))


@few
def test_beside_a_gain_the_motors_side_with_the_same_friction_is_proposed(k: float) -> None:
    shape = LAW.sharper_shape(np.array([k / (1 - k**2)]), {}, {"torque_gain"})
    assert shape == pytest.approx({"K": k, "side": MOTOR})
    assert LAW.sharper_shape(np.array([k]), {}, {"torque_offset"}) is None


def test_the_motors_side_is_sharpened_until_it_is_made_linear_about_its_own_value() -> None:
    shape = {"K": TRIED[0], "side": MOTOR}
    near = TRIED[0] * (1.0 + 0.5 * SHARP)
    assert LAW.sharper_shape(np.array([near]), shape, ()) is None
    assert LAW.sharper_shape(np.array([0.1]), shape, ()) == pytest.approx({"K": 0.1, "side": MOTOR})


def test_every_friction_between_the_least_and_the_largest_is_within_the_bounds_of_a_shape() -> None:
    bounds = [LAW.bounds({"K": k, "side": MOTOR}) for k in TRIED]
    for k in np.geomspace(0.094, 0.3, 50):
        assert any(low[0] <= k <= high[0] for low, high in bounds)
