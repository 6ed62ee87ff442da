"""Torques of bodies by Newton-Euler are those of their regressors."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.effects.motion import Motion
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.models.corrected.tilted_bodies import fields_of, weight
from lagnet.rigid_body.inertia import parameters_of_body
from lagnet.rigid_body.robot import load_description

IDENTITY = 1e-11  # [N m]: rounding of two ways to the same torque
BODY = parameters_of_body(2.0, np.array([0.1, 0.05, 0.02]), np.diag([0.01, 0.02, 0.015]))


def _motion() -> Motion:
    robot, rng = load_description("ur5").with_armature(np.full(6, 0.3)), np.random.default_rng(0)
    q, v, a = rng.normal(size=(3, 40, 6))
    return Motion(np.arange(40) * 0.01, q, v, a, q, np.ones(6), robot)


@pytest.mark.parametrize("joint", [0, 2, 5])
@pytest.mark.parametrize("change", [BODY, -BODY, np.r_[0.0, BODY[1:]]])
def test_the_torque_of_a_body_is_that_of_its_regressor(joint, change) -> None:
    expected = _motion().link_regressor(joint) @ change
    motion = _motion()
    for _ in range(3):  # by Newton-Euler, then by columns that are kept
        assert motion.body_torque(joint, change) == pytest.approx(expected, abs=IDENTITY)


def test_the_weight_of_a_body_is_that_of_its_regressor() -> None:
    payload, gravity = {"m": 2.0, "cx": 0.1, "cy": 0.05, "cz": 0.02}, np.array([1.0, -2.0, -9.81])
    payload |= {"Ixx": 0.01, "Iyy": 0.02, "Izz": 0.015, "Ixy": 0.0, "Ixz": 0.0, "Iyz": 0.0}
    known, effect = _motion(), NamedEffect("payload", None, payload)
    fields_of(known, 5)
    assert weight(_motion(), effect, gravity) == pytest.approx(weight(known, effect, gravity), abs=IDENTITY)
