"""An arm on a wall, a slope or a ceiling, against a model that stands upright."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.diagnose import diagnose
from lagnet.effects.catalogue import effect_named
from lagnet.effects.inertia.gravity_tilt import GravityTilt

DOWN = {  # gravity in the frame of the base, in parts of g
    "wall": (0.0, -1.0, 0.0),
    "other wall": (0.96, 0.28, 0.0),
    "ceiling": (0.0, 0.0, 1.0),
    "nearly a ceiling": (0.02, -0.03, 0.999),
    "slope": (0.5, 0.5, -0.7),
}
WRONG = np.deg2rad(0.3)


def mounted(arm, place: str):
    down = np.array(DOWN[place])
    return arm.with_gravity(9.81 * down / np.linalg.norm(down))


def friction(q, v, a, body):
    return 2.0 * np.tanh(v / 1e-3) + 1.5 * v


@pytest.mark.parametrize("place", DOWN)
def test_the_tilt_is_named_and_the_friction_behind_it(place, plant, arm, at, names) -> None:
    real = plant(at(1, friction), robot=mounted(arm, place))
    result = diagnose([real.record(1), real.record(2)], arm, [real.record(3)])
    own = {("viscous_friction", arm.joints[1]), ("coulomb_friction", arm.joints[1])}
    assert names(result) == {("gravity_tilt", None), *own}
    found = {e.effect: e for e in result.effects}
    turn = {name: found["gravity_tilt"].value(name) for name in ("theta_1", "theta_2")}
    law = effect_named("gravity_tilt")
    assert isinstance(law, GravityTilt)
    direction = law.gravity_of(arm.gravity, turn) / 9.81
    truth = real.robot.gravity / 9.81
    assert np.linalg.norm(direction - truth) < WRONG
    assert f"turned by {np.rad2deg(np.arccos(-truth[2])):.0f}°" in found["gravity_tilt"].explanation
    assert found["coulomb_friction"].value("Fc") == pytest.approx(2.0, rel=0.02)
    np.testing.assert_allclose(result.corrected.bodies().gravity, real.robot.gravity, atol=0.06)


@pytest.mark.slow
def test_a_payload_on_a_wall_is_found_too(plant, arm, names) -> None:
    real = plant(robot=mounted(arm, "wall").with_payload(1.5, np.array([0.05, 0.08, 0.15]), 0.006 * np.eye(3)))
    result = diagnose([real.record(1), real.record(2)], arm, [real.record(3)])
    assert names(result) == {("gravity_tilt", None), ("payload", None)}
    assert {e.effect: e for e in result.effects}["payload"].value("m") == pytest.approx(1.5, rel=0.02)


def test_large_turns_are_looked_for_only_where_torque_asks_for_them(plant, arm, posed_motion) -> None:
    law = effect_named("gravity_tilt")
    assert len(law.shapes(posed_motion(plant(robot=mounted(arm, "wall"))), None)) == 2
    heavy = arm.with_payload(5.0, np.array([0.1, 0.1, 0.2]), 0.02 * np.eye(3))
    for real in (plant(), plant(robot=heavy), plant(lambda q, v, a, body: 0.5 * body)):
        assert law.shapes(posed_motion(real), None) == ({},)


@pytest.fixture
def posed_motion(arm):
    from lagnet.diagnosis.problem.problem import pose_problem
    from lagnet.recordings.conditioning.condition import condition

    def of(real):
        fit, unseen = (condition([real.record(seed)], 10.0) for seed in (1, 2))
        return pose_problem(arm, fit, unseen).summary()

    return of
