"""A torque that is a sinusoid of time has no name of a law that follows the motion that it causes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.diagnosis.rules.cases import JOINT, Bench, hum_as_rotor, rotor_beside_unlisted_drag

from lagnet.diagnosis.rules.periodic_disturbance import PeriodicDisturbance


@pytest.fixture(scope="module")
def bench(arm, plant, at) -> Bench:
    return Bench(arm, plant, at, {})


def test_the_frequency_is_told(bench) -> None:
    (rejected,) = PeriodicDisturbance().rejected(hum_as_rotor(bench))
    assert (rejected.effect, rejected.joint) == ("rotor_inertia", JOINT)
    assert "0.5 Hz" in rejected.detail
    assert rejected.value < 0.1


def test_the_drag_beside_a_rotor_is_left_unexplained(bench) -> None:
    candidate = rotor_beside_unlisted_drag(bench)
    left = candidate.power("fit")[JOINT] / candidate.noise[JOINT] ** 2
    assert left > 10.0, "so that the rule is asked"
    assert PeriodicDisturbance().rejected(candidate) == ()
    assert PeriodicDisturbance(most_left=np.inf, nothing=np.inf).rejected(candidate)


def test_motion_of_less_than_three_periods_has_no_frequency(bench) -> None:
    candidate = hum_as_rotor(bench)
    slow = replace(candidate, problem=replace(candidate.problem, bandwidth=0.1))
    assert PeriodicDisturbance().rejected(slow) == ()
