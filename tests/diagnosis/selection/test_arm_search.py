"""The search over the whole arm: what counts as evidence, and which arm-wide hypotheses are tried."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.selection.arm_search import refit_selection, search_arm
from lagnet.effects.signal.encoder_offset import EncoderOffset

ELASTICITY = "joint_elasticity"
NOISY = 0.1  # of each joint's usual torque


def names(posed, found) -> list[tuple[str, int | None]]:
    return [posed.library.hypotheses[i].place for i in found.indices]


@pytest.fixture
def noisy(plant, arm):
    """Nothing is left out, and the torque is noisy."""
    real = replace(plant(), noise=NOISY)
    return pose(arm, real.record(1), real.record(2))


@pytest.mark.parametrize("joint", range(3))
def test_a_law_that_follows_from_the_measured_torque_does_not_count_for_its_noise(noisy, joint: int) -> None:
    nothing = noisy.select({})
    flexible = refit_selection(noisy.equations, replace(nothing, arm_wide=(noisy.index(ELASTICITY, joint),)))
    assert flexible.fit.sse[joint] < 0.9 * nothing.fit.sse[joint]  # noise is like its own second derivative
    assert flexible.score < nothing.score


def test_nothing_is_found_in_noise(noisy) -> None:
    assert names(noisy, noisy.search()) == []


@pytest.mark.parametrize("link", [0, 1])
def test_the_mass_of_a_link_is_found_under_noise(plant, arm, link: int) -> None:
    bodies = arm.inertial_parameters()
    bodies[link] *= 1.1
    real = replace(plant(robot=arm.with_inertial_parameters(bodies)), noise=NOISY)
    posed = pose(arm, real.record(1), real.record(2))
    found = posed.search()
    assert names(posed, found) == [("link_inertia", link)]
    share = found.fit.coefficients[found.arm_wide[0]]
    assert share == pytest.approx(np.array([0.1]), rel=0.2)


def test_what_is_not_physical_is_dropped_before_the_load_beside_it(plant, arm, monkeypatch) -> None:
    monkeypatch.setattr(EncoderOffset, "plausible", lambda law, coefficients, shape: False)
    real = plant(robot=arm.with_payload(1.0, np.array([0.0, 0.0, 0.08]), 3e-4 * np.eye(3)))
    posed = pose(arm, real.record(1), real.record(2))
    load, offset = posed.index("payload", None), posed.index("encoder_offset", 1)
    start = refit_selection(posed.equations, replace(posed.select({}, ("payload",)), arm_wide=(load, offset)))
    assert start.score == -np.inf
    found = search_arm(posed.equations, start.scales.noise_power, start.scales.torque_power, (start,))
    assert found.arm_wide == (load,)
