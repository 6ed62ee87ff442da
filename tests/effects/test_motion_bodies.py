"""Torques of bodies by Newton-Euler are those of their regressors."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.effects import motion as module
from lagnet.effects.motion import Motion
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.models.corrected.tilted_bodies import fields_of, weight
from lagnet.rigid_body.changed_bodies_torque import torque_of_change
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
    for size in (1.0, 1.0, 2.0, 3.0, 1.0):  # by Newton-Euler, as kept, then by columns
        assert motion.body_torque(joint, size * change) == pytest.approx(size * expected, abs=2.0 * IDENTITY)


def test_a_body_is_computed_once_for_the_same_parameters(monkeypatch: pytest.MonkeyPatch) -> None:
    computed = []
    monkeypatch.setattr(module, "torque_of_change", lambda *given: computed.append(given) or torque_of_change(*given))
    motion = _motion()
    first = motion.body_torque(2, BODY)
    assert motion.body_torque(2, BODY.copy()) is first
    assert motion.body_torque(3, BODY) is not first
    assert len(computed) == 2
    with pytest.raises(ValueError, match="read-only"):
        first += 1.0


def test_the_weight_of_a_body_is_that_of_its_regressor() -> None:
    payload, gravity = {"m": 2.0, "cx": 0.1, "cy": 0.05, "cz": 0.02}, np.array([1.0, -2.0, -9.81])
    payload |= {"Ixx": 0.01, "Iyy": 0.02, "Izz": 0.015, "Ixy": 0.0, "Ixz": 0.0, "Iyz": 0.0}
    known, effect = _motion(), NamedEffect("payload", None, payload)
    fields_of(known, 5)
    assert weight(_motion(), effect, gravity) == pytest.approx(weight(known, effect, gravity), abs=IDENTITY)
