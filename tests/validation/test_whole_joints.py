"""Plants on which every joint has all that real joints have: what is on the torque, and what counts as a wrong name."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from validation.whole_joints.plants import MASSES, NOISE, SLOW, draw
from validation.whole_joints.study import REFUSED, is_wrong, summary


@pytest.fixture(scope="module")
def plant():
    return draw(1)


def test_the_model_knows_one_mass_for_all_links(plant) -> None:
    masses = plant.nominal.inertial_parameters()[:, 0]
    assert set(masses) == {MASSES[0]}
    assert np.ptp(plant.true.inertial_parameters()[:, 0]) > 0.1


def test_what_is_beside_the_bodies_is_the_friction_rotor_strut_and_disturbance(plant) -> None:
    quiet = plant.record(5)
    n = len(quiet.time)
    omega = np.fft.rfftfreq(n, quiet.time[1])
    assert omega[np.argmax(np.abs(np.fft.rfft(quiet.q[:, 0] - quiet.q[:, 0].mean())))] <= 0.6  # [Hz]
    v = np.gradient(quiet.q, quiet.time, axis=0)
    a = np.gradient(v, quiet.time, axis=0)
    body = plant.true.inverse_dynamics(quiet.q, v, a)
    left = quiet.tau - body - plant.per_load * np.abs(body) * np.sign(v)
    for joint in (0, 2):
        beyond = np.abs(v[:, joint]) > 0.3  # Stribeck's excess is gone
        columns = np.column_stack([np.sign(v[:, joint]), np.ones(n), v[:, joint], a[:, joint]])[beyond]
        found, *_ = np.linalg.lstsq(columns, left[beyond, joint], rcond=None)
        dry = plant.dry[:, joint]
        about = 4.0 * (NOISE + SLOW) * np.std(quiet.tau[:, joint])
        assert found[0] == pytest.approx(dry.mean(), abs=about)
        assert found[1] == pytest.approx((dry[0] - dry[1]) / 2.0, abs=about)


@pytest.mark.parametrize(
    ("effect", "joint", "tied", "wrong"),
    [
        ("viscous_friction", 3, (), False),
        ("quadratic_drag", 3, (), True),
        ("quadratic_drag", 3, ("viscous_friction",), False),
        ("joint_spring", 1, (), False),
        ("joint_spring", 0, (), True),
        ("joint_elasticity", 2, (), True),
        ("payload", None, (), False),
    ],
)
def test_a_name_is_wrong_where_neither_it_nor_what_it_is_tied_with_is_there(plant, effect, joint, tied, wrong) -> None:
    name = None if joint is None else plant.true.joints[joint]
    assert is_wrong(SimpleNamespace(effect=effect, joint=name, tied_with=tied), plant) is wrong


def test_a_plant_that_is_refused_is_counted_as_that_alone() -> None:
    told = {
        "joints": 2, "refused": None, "identified": [1.0, 3.0], "least_squares": [2.0, 2.0], "worse": 1, "names": ["a"],
        "wrong_names": [], "beside_free_links": False, "seconds": 5.0,
    }  # fmt: skip
    figures = summary([told, {**REFUSED, "joints": 6, "refused": "another unit"}])
    assert (figures["plants"], figures["refused"], figures["joints"]) == (1, 1, 2)
    assert figures["largest_ratio_to_least_squares"] == 1.5
