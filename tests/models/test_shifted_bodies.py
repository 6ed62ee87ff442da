"""A flexible joint or a gap beside a payload gives the torque of an arm that carries it, at the joint's true angle."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.models.test_tilted_bodies import BODIES, PAYLOAD, SLOW, TILT

from lagnet.effects.catalogue import effect_named
from lagnet.effects.motion import Motion
from lagnet.effects.transmission import Transmission
from lagnet.models.corrected.model import CorrectedModel, NamedEffect, torque_with
from lagnet.models.corrected.shifted_bodies import shifted_bodies, transmission_columns
from lagnet.rigid_body.robot import load_description

JOINT = 1
FLEXIBLE = NamedEffect("joint_elasticity", JOINT, {"K": 1500.0})
LOOSE = NamedEffect("backlash", JOINT, {"h": 0.004})
PASSING = tuple(replace(body, interval=(0.4, 1.1)) for body in BODIES)


@pytest.fixture(scope="module")
def ur5():
    return load_description("ur5")


@pytest.fixture(scope="module")
def motion(ur5) -> Motion:
    """Sines of all joints, with the torque of the arm as the recorded one."""
    time = np.arange(500) / 250.0
    rate = np.array([2.1, 3.0, 1.7, 4.2, 2.6, 3.3])
    angle = time[:, None] * rate + np.arange(6.0)
    q, v, a = 0.8 * np.sin(angle), 0.8 * rate * np.cos(angle), -0.8 * rate**2 * np.sin(angle)
    return Motion(time, q, v, a, ur5.inverse_dynamics(q, v, a), SLOW, ur5)


def transmission(effect: NamedEffect) -> Transmission:
    law = effect_named(effect.effect)
    assert isinstance(law, Transmission)
    return law


@pytest.mark.parametrize("others", [(TILT,), BODIES, (TILT, *BODIES)], ids=["tilt", "bodies", "both"])
@pytest.mark.parametrize("effect", [FLEXIBLE, LOOSE], ids=["flexible", "loose"])
def test_the_arm_that_carries_them_stands_where_the_link_is(ur5, motion, effect, others) -> None:
    """RNEA of the arm with all bodies written into it, at q + dq under its own load, is the sum of the parts."""
    arm = CorrectedModel(ur5, others, SLOW).bodies()
    load = motion.with_load(torque_with(motion, others))
    dq, dv, da = transmission(effect).shift(load, JOINT, effect.values)
    unit = np.eye(6)[JOINT]
    expected = arm.inverse_dynamics(
        *(x + d[:, None] * unit for x, d in zip((motion.q, motion.v, motion.a), (dq, dv, da), strict=True))
    )
    found = torque_with(motion, [*others, effect])
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-6)
    apart = torque_with(motion, others) + torque_with(motion, [effect]) - motion.load
    assert np.max(np.abs(apart - expected)) > 1e-3


def test_nothing_is_added_without_tilt_and_bodies_or_without_transmission(motion) -> None:
    assert np.all(np.asarray(shifted_bodies(motion, (FLEXIBLE, LOOSE))) == 0.0)
    assert np.all(np.asarray(shifted_bodies(motion, (TILT, *BODIES))) == 0.0)


def test_a_link_before_the_joint_is_not_moved_by_it(motion) -> None:
    behind = NamedEffect("link_inertia", JOINT - 1, dict(BODIES[1].values))
    assert np.all(np.asarray(shifted_bodies(motion, (FLEXIBLE, behind))) == 0.0)


@pytest.mark.parametrize("compliance", [1e-6, 1e-5])
def test_the_search_sees_a_flexible_joint_under_the_payload_that_was_found(motion, compliance) -> None:
    """Columns times 1/K are the torque to first order."""
    payload = NamedEffect("payload", None, PAYLOAD)
    load = motion.with_load(torque_with(motion, [payload]))
    columns = transmission_columns(load, transmission(FLEXIBLE), JOINT, [payload], {})
    effect = NamedEffect("joint_elasticity", JOINT, {"K": 1.0 / compliance})
    exact = torque_with(motion, [payload, effect]) - load.load
    error = np.abs(columns[..., 0] * compliance - exact)[5:-5].max()
    assert error < 0.01 * np.abs(exact).max()


class BodiesAlone:
    """A model with the bodies of an arm that is none: no derivatives of it are known."""

    def __init__(self, arm) -> None:
        self.joints, self.n_dof, self.gravity = arm.joints, arm.n_dof, arm.gravity
        self.inverse_dynamics, self.joint_torque_regressor = arm.inverse_dynamics, arm.joint_torque_regressor
        self.link_regressor, self.weight_regressor = arm.link_regressor, arm.weight_regressor
        self.gravity_regressor, self.inertial_parameters = arm.gravity_regressor, arm.inertial_parameters


@pytest.mark.parametrize("others", [(TILT,), BODIES, (TILT, *BODIES), (TILT, *PASSING)], ids=range(4))
@pytest.mark.parametrize("joint", [1, 2])
def test_derivatives_are_the_differences_of_a_model_that_has_none(motion, others, joint) -> None:
    law = transmission(FLEXIBLE)
    found = transmission_columns(motion, law, joint, others, {})
    opaque = replace(motion, model=BodiesAlone(motion.model), cache={})
    expected = transmission_columns(opaque, law, joint, others, {})
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-5 * np.abs(expected).max())
    alone = law.columns(motion, joint, {})
    assert np.abs(found - alone).max() > 1e-3 * np.abs(alone).max()


def test_a_link_before_the_joint_leaves_its_columns_alone(motion) -> None:
    behind = NamedEffect("link_inertia", JOINT - 1, dict(BODIES[1].values))
    opaque = replace(motion, model=BodiesAlone(motion.model), cache={})
    law = transmission(FLEXIBLE)
    for seen in (motion, opaque):
        alone = law.columns(seen, JOINT, {})
        found = transmission_columns(seen, law, JOINT, [behind], {})
        np.testing.assert_allclose(found, alone, rtol=0, atol=1e-9 * np.abs(alone).max())
