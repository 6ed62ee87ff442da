"""No load leaves less of a recording than ten free numbers do; where these explain little, none is looked for."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.problem.problem import pose_problem
from lagnet.diagnosis.transients.least_left import least_left, may_have_load
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.recordings.conditioning.condition import condition

MASS, CENTRE = 1.5, np.array([0.03, 0.0, 0.15])  # [kg], [m] in the frame of the last link
NOISE = 1e-4  # [N² m²]


@pytest.fixture(scope="module")
def problem(plant, arm, at):
    """Two recordings: one with a load, one with a torque that changes with the square of an angle; the same rubs."""
    loaded = arm.with_payload(MASS, CENTRE, 0.004 * np.eye(3))
    rubs = at(1, lambda q, v, a, body: 3.0 * v)

    def load(q, v, a, body):
        return loaded.inverse_dynamics(q, v, a) - arm.inverse_dynamics(q, v, a)

    square = at(0, lambda q, v, a, body: 40.0 * q**2)
    given = condition([plant(load, rubs).record(21), plant(square, rubs).record(22)])
    return pose_problem(arm, given, given)


RUBS = (NamedEffect("viscous_friction", 1, {"Fv": 1.0}),)  # a third of it


@pytest.mark.parametrize(("recording", "may"), [(0, True), (1, False)])
def test_a_recording_with_a_load_may_have_one(problem, recording, may) -> None:
    assert may_have_load(problem, [recording], RUBS, np.full(3, NOISE)) == may


def test_one_recording_with_a_load_suffices(problem) -> None:
    assert may_have_load(problem, [0, 1], RUBS, np.full(3, NOISE))


def test_the_best_combination_leaves_what_is_no_combination() -> None:
    rng = np.random.default_rng(0)
    columns, weights = rng.normal(size=(500, 2, 3)), rng.normal(size=3)
    alien = rng.normal(size=(500, 2))
    residual, valid = columns @ weights + alien, np.ones((500, 2), dtype=bool)
    power = np.full(2, 0.01)
    left = least_left([(residual, columns, valid)], power)
    assert left == pytest.approx(np.sum(alien**2) / np.sum(residual**2), rel=0.05)
    assert least_left([(columns @ weights, columns, valid)], power) == 0.0
    assert least_left([(0.01 * residual, columns, valid)], power) == 1.0, "within noise nothing is explained"
