"""Bodies take the place of gains that stand for them, and of no true gain."""

from __future__ import annotations

import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.selection.gain_exchange import GAIN, exchange_gains

FACTOR = 1.6  # of the last link's mass and inertia


def gains(posed, found) -> set[int | None]:
    chosen = (posed.library.hypotheses[i] for i in found.indices)
    return {h.joint for h in chosen if h.effect == GAIN}


@pytest.fixture(scope="module")
def heavier(plant, arm):
    parameters = arm.inertial_parameters().copy()
    parameters[-1] *= FACTOR
    real = plant(robot=arm.with_inertial_parameters(parameters))
    return pose(arm, real.record(41), real.record(42))


@pytest.mark.parametrize("arm_wide", [[], ["payload"]])
def test_a_heavier_link_takes_the_place_of_gains_alone_and_beside_it(heavier, arm, arm_wide) -> None:
    found = heavier.select({0: [GAIN], 2: [GAIN]}, arm_wide)
    better = exchange_gains(heavier.equations, found)
    assert better.score > found.score
    assert gains(heavier, better) == set()
    mass = (FACTOR - 1.0) * arm.inertial_parameters()[-1, 0]
    assert better.fit.coefficients[better.arm_wide[0]][0] == pytest.approx(mass, rel=0.02)


def test_gains_of_both_signs_are_no_heavier_link(heavier) -> None:
    found = heavier.select({0: [GAIN], 1: [GAIN]})
    assert len({found.fit.coefficients[own[0]][0] > 0 for own in found.local if own}) == 2
    assert exchange_gains(heavier.equations, found) is found


def test_a_true_gain_stays(plant, arm, at) -> None:
    real = plant(at(1, lambda q, v, a, body: 0.2 * body))
    posed = pose(arm, real.record(41), real.record(42))
    found = posed.search()
    assert gains(posed, found) == {1}
    assert exchange_gains(posed.equations, found) is found


def test_a_selection_without_gains_is_given_back_as_it_is(plant, arm, at) -> None:
    real = plant(at(1, lambda q, v, a, body: 3.0 * v))
    posed = pose(arm, real.record(41), real.record(42))
    found = posed.search()
    assert exchange_gains(posed.equations, found) is found
