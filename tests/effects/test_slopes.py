"""Slopes of the torque about one joint are its derivatives, and what laws of transmissions share of them is exact."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lagnet.effects.catalogue import CATALOGUE
from lagnet.effects.motion import Motion
from lagnet.effects.slopes import first_order, per_acceleration, per_angle, per_speed
from lagnet.rigid_body.random_arm import random_arm

N, JOINT, SMALL = 3, 1, 1e-5


@pytest.fixture(scope="module")
def motion() -> Motion:
    """A swing of three joints."""
    arm, time = random_arm(N, seed=4), np.linspace(0.0, 3.0, 300)
    omega = np.array([1.3, 2.1, 3.0])
    q, v, a = (
        np.sin(omega * time[:, None]),
        omega * np.cos(omega * time[:, None]),
        -(omega**2) * np.sin(omega * time[:, None]),
    )
    return Motion(time, q, v, a, arm.inverse_dynamics(q, v, a), np.full(N, 0.05), arm)


class Opaque:
    """A model that gives torques and nothing else, as a learned one."""

    def __init__(self, arm) -> None:
        self.inverse_dynamics = arm.inverse_dynamics


def moved(motion: Motion, dq: float = 0.0, dv: float = 0.0, da: float = 0.0) -> np.ndarray:
    """Torque beside the recorded motion."""
    shift = np.eye(N)[JOINT]
    return motion.model.inverse_dynamics(motion.q + dq * shift, motion.v + dv * shift, motion.a + da * shift)


LAWS = [(per_angle, "dq"), (per_speed, "dv"), (per_acceleration, "da")]


@pytest.mark.parametrize("law", [law for law, _ in LAWS])
def test_of_a_model_without_derivatives_they_are_differences(motion: Motion, law) -> None:
    known = law(motion, JOINT)
    opaque = replace(motion, model=Opaque(motion.model), cache={})
    np.testing.assert_allclose(law(opaque, JOINT), known, atol=1e-5 * np.abs(known).max())


@pytest.mark.parametrize(("law", "of"), LAWS)
def test_they_are_derivatives(motion: Motion, law, of: str) -> None:
    expected = (moved(motion, **{of: SMALL}) - moved(motion, **{of: -SMALL})) / (2.0 * SMALL)
    np.testing.assert_allclose(law(motion, JOINT), expected, rtol=1e-7, atol=1e-7 * np.abs(expected).max())


def test_first_order_is_their_sum(motion: Motion) -> None:
    changes = np.random.default_rng(0).normal(size=(3, len(motion.time)))
    slopes = [law(motion, JOINT) for law in (per_angle, per_speed, per_acceleration)]
    expected = np.einsum("kn,knj->nj", changes, np.array(slopes))
    np.testing.assert_allclose(first_order(motion, JOINT, *changes), expected, rtol=1e-12, atol=1e-12)


def test_the_column_of_an_elastic_joint_is_its_law_for_little_compliance(motion: Motion) -> None:
    law = CATALOGUE["joint_elasticity"]
    compliance = 1e-7
    column = law.columns(motion, JOINT, {})[..., 0]
    exact = law.torque(motion, JOINT, {"K": 1.0 / compliance}) / compliance
    np.testing.assert_allclose(column, exact, atol=1e-3 * np.abs(exact).max())
