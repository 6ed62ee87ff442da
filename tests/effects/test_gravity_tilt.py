"""Turns of the base: directions and turns are each other's inverse, and large turns are linear about themselves."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.effects.catalogue import effect_named
from lagnet.effects.inertia.gravity_tilt import GravityTilt

TURNS = [(0.0, 1.2), (-2.0, 0.5), (np.pi / 2, 0.0), (0.4, -0.4), (3.0, -0.3)]
GRAVITIES = [(0.0, 0.0, -9.81), (9.0, -3.0, 1.0), (0.0, 0.0, 9.81)]
STEP = 1e-6


@pytest.fixture
def law() -> GravityTilt:
    found = effect_named("gravity_tilt")
    assert isinstance(found, GravityTilt)
    return found


@pytest.mark.parametrize("gravity", GRAVITIES, ids=str)
@pytest.mark.parametrize("turn", TURNS, ids=str)
def test_a_large_turn_is_linear_about_itself(law, turn, gravity) -> None:
    shape, down = dict(zip(("theta_1", "theta_2"), turn, strict=True)), np.array(gravity)
    changes = law.changes(down, shape)
    np.testing.assert_allclose(down + changes[:, 0], law.gravity_of(down, shape), atol=1e-12)
    for step in (np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])):
        moved = law.gravity_of(down, law.values(np.array([1.0, 0.0, 0.0]) + STEP * step, shape))
        np.testing.assert_allclose((moved - law.gravity_of(down, shape)) / STEP, changes @ step, atol=1e-4)


@pytest.mark.parametrize("turn", TURNS, ids=str)
def test_the_shape_with_nothing_added_is_the_turn(law, turn) -> None:
    shape = dict(zip(("theta_1", "theta_2"), turn, strict=True))
    assert law.values(np.array([1.0, 0.0, 0.0]), shape) == pytest.approx(shape, abs=1e-12)


def test_the_base_that_hangs_upside_down(law) -> None:
    down = np.array([0.0, 0.0, -9.81])
    np.testing.assert_allclose(law.gravity_of(down, {"theta_1": np.pi, "theta_2": 0.0}), -down, atol=1e-12)
    assert "180°" in law.remark({"theta_1": np.pi, "theta_2": 0.0})
    assert law.remark({"theta_1": 0.1, "theta_2": -0.2}) == ""
