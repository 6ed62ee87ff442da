"""Loads that are added to recordings, and when an answer about them is right."""

from __future__ import annotations

import numpy as np
import pytest
from validation.real_arms.added_loads import TWO, Load, _is_right

from lagnet.recordings.recording import Recording
from lagnet.rigid_body.robot import load_description

CENTRE = np.array([0.05, -0.02, 0.1])  # [m]
LOAD = Load(1.5, CENTRE, 0.05)
RATE = 125.0  # [Hz]


@pytest.fixture(scope="module")
def ur5():
    return load_description("ur5")


@pytest.fixture(scope="module")
def recording(ur5) -> Recording:
    time = np.arange(0.0, 8.0, 1.0 / RATE)
    q = 0.6 * np.sin(np.outer(time, np.linspace(1.0, 2.5, 6))) + 0.3
    return Recording(time, q, np.zeros_like(q), ur5.joints)


def test_the_torque_of_a_load_is_its_weight_and_inertia_along_the_motion(ur5, recording) -> None:
    rates = np.linspace(1.0, 2.5, 6)
    phase = np.outer(recording.time, rates)
    v, a = 0.6 * rates * np.cos(phase), -0.6 * rates**2 * np.sin(phase)
    inertia = 0.4 * LOAD.mass * LOAD.radius**2 * np.eye(3)
    loaded = ur5.with_payload(LOAD.mass, CENTRE, inertia)
    expected = loaded.inverse_dynamics(recording.q, v, a) - ur5.inverse_dynamics(recording.q, v, a)
    inside = slice(50, -50)  # of the filter's ends
    found = (LOAD.on(ur5, recording).torque - recording.torque)[inside]
    np.testing.assert_allclose(found, expected[inside], atol=0.01 * np.abs(expected).max())


def test_what_one_load_is_beyond_another_has_mass_and_first_moment_of_both() -> None:
    light = Load(0.5, np.array([0.0, 0.1, 0.0]), 0.05)
    mass, centre = LOAD.beyond(light)
    assert mass == pytest.approx(1.0)
    np.testing.assert_allclose(mass * centre, 1.5 * CENTRE - 0.5 * light.centre)


@pytest.mark.parametrize(
    ("loads", "truth", "right"),
    [
        ([(1, 1.45, CENTRE)], (1, 1.5, CENTRE), True),
        ([(0, 1.45, CENTRE)], (1, 1.5, CENTRE), False),  # in the other recording
        ([(1, 1.2, CENTRE)], (1, 1.5, CENTRE), False),
        ([(1, 1.5, CENTRE + 0.04)], (1, 1.5, CENTRE), False),
        ([(0, 0.3, CENTRE), (1, 1.5, CENTRE)], (1, 1.5, CENTRE), False),
        ([], (1, 1.5, CENTRE), False),
        ([(1, 1.0, CENTRE)], (TWO, 1.0, CENTRE), True),  # beyond what the first has
        ([(0, 2.0, CENTRE), (1, 3.0, CENTRE)], (TWO, 1.0, CENTRE), True),  # with what the model's last link lacks
        ([(0, 3.0, CENTRE), (1, 2.0, CENTRE)], (TWO, 1.0, CENTRE), False),
        ([(None, 2.0, -CENTRE), (1, 1.0, CENTRE)], (TWO, 1.0, CENTRE), True),  # both have two kilograms
        ([(None, 1.0, CENTRE), (1, 2.0, CENTRE)], (TWO, 1.0, CENTRE), False),
        ([(None, 1.0, CENTRE)], (TWO, 1.0, CENTRE), False),
        ([], None, True),
        ([(None, 2.0, CENTRE)], None, True),  # both recordings have it: the model's last link
        ([(1, 0.4, CENTRE)], None, False),
    ],
)
def test_an_answer_is_right_where_the_one_load_is_there_alone(loads, truth, right: bool) -> None:
    assert _is_right(loads, truth, 2) is right


def test_one_free_recording_has_no_load_at_all() -> None:
    assert not _is_right([(None, 0.5, CENTRE)], None, 1)
