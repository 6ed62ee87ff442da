"""What changes of a sum of effects when one changes, against the sum computed anew."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lagnet.diagnosis.estimation.superposition import Change, Superposition
from lagnet.effects.catalogue import CATALOGUE
from lagnet.effects.motion import Motion
from lagnet.models.corrected.model import NamedEffect, torque_with
from lagnet.rigid_body.robot import load_description

ROUNDING = 1e-10  # relative, of differences of sums

EFFECTS = (
    NamedEffect("payload", None, dict(enumerate((1.2, 0.01, 0.02, 0.1, 0.01, 0, 0.01, 0, 0, 0.01)))),
    NamedEffect("gravity_tilt", None, {"theta_1": 0.03, "theta_2": -0.02}),
    NamedEffect("rotor_inertia", 1, {"Ia": 0.3}),
    NamedEffect("joint_elasticity", 1, {"K": 4000.0, "D": 20.0}),
    NamedEffect("backlash", 4, {"h": 0.002}),
    NamedEffect("viscous_friction", 0, {"Fv": 2.0}),
    NamedEffect("load_dependent_friction", 1, {"mu": 0.05}),
    NamedEffect("load_dependent_friction", 2, {"mu": 0.02}),
    NamedEffect("torque_gain", 1, {"K": 0.95}),
    NamedEffect("time_delay", 1, {"T": 0.004}),
    NamedEffect("torque_offset", 2, {"tau0": 0.3}),
)  # fmt: skip

MOVING = ("payload", "rotor_inertia", "joint_elasticity", "backlash")  # move links behind transmissions


@pytest.fixture(scope="module")
def motion() -> Motion:
    """Sines of all joints of a UR-5."""
    arm, time = load_description("ur5"), np.arange(400) / 200.0
    angle = time[:, None] * np.array([2.1, 3.0, 1.7, 4.2, 2.6, 3.3]) + np.arange(6.0)
    rate = np.array([2.1, 3.0, 1.7, 4.2, 2.6, 3.3])
    q, v, a = 0.8 * np.sin(angle), 0.8 * rate * np.cos(angle), -0.8 * rate**2 * np.sin(angle)
    return Motion(time, q, v, a, arm.inverse_dynamics(q, v, a), np.full(6, 0.01), arm)


def given(effect: NamedEffect) -> NamedEffect:
    """With the names of parameters that the catalogue has, in its order."""
    names = [p.name for p in CATALOGUE[effect.effect].free_parameters]
    return NamedEffect(effect.effect, effect.joint, dict(zip(names, effect.values.values(), strict=True)))


@pytest.mark.parametrize("recorded", [False, True], ids=["modelled load", "recorded load"])
@pytest.mark.parametrize("n", range(len(EFFECTS)))
def test_a_small_change_is_the_difference_of_two_sums(n: int, recorded: bool, motion: Motion) -> None:
    """Of second order is what transmissions make of it: a tenth of the step, a hundredth of the error."""
    motion = replace(motion, recorded=1.1 * motion.load if recorded else None, cache={})
    effects = [given(e) for e in EFFECTS]
    sums, errors = Superposition(motion, effects), []
    for step in (1e-3, 1e-4):
        other = effects[n].at_coordinates((1.0 + step) * effects[n].coordinates())
        anew = torque_with(motion, [*effects[:n], other, *effects[n + 1 :]]) - sums.total
        told = at_all(sums.change(n, other), anew)
        errors.append(np.abs(told - anew).max())
        assert errors[-1] < 3.0 * step * np.abs(anew).max() + ROUNDING
    assert errors[1] < 0.015 * errors[0] + ROUNDING * largest(motion)


@pytest.mark.parametrize("n", [n for n, e in enumerate(EFFECTS) if e.effect not in MOVING])
def test_a_change_that_moves_no_link_is_the_difference_of_two_sums(n: int, motion: Motion) -> None:
    effects = [given(e) for e in EFFECTS]
    x = effects[n].coordinates()
    other = effects[n].at_coordinates(1.01 * x)
    sums = Superposition(motion, effects)
    np.testing.assert_allclose(sums.total, torque_with(motion, effects), rtol=1e-12, atol=1e-12)
    anew = torque_with(motion, [*effects[:n], other, *effects[n + 1 :]]) - torque_with(motion, effects)
    assert np.abs(anew).max() > 0
    np.testing.assert_allclose(at_all(sums.change(n, other), anew), anew, rtol=0, atol=ROUNDING * largest(motion))


@pytest.mark.parametrize("n", range(len(EFFECTS)))
def test_an_effect_that_goes_takes_all_with_it_that_followed_from_it(n: int, motion: Motion) -> None:
    effects = [given(e) for e in EFFECTS]
    anew = torque_with(motion, [*effects[:n], *effects[n + 1 :]]) - torque_with(motion, effects)
    told = at_all(Superposition(motion, effects).without(n), anew)
    assert np.abs(anew).max() > 0
    np.testing.assert_allclose(told, anew, rtol=0, atol=ROUNDING * largest(motion))


def at_all(change: Change, like: np.ndarray) -> np.ndarray:
    """A change with zeros at the joints that it leaves out."""
    told = np.zeros_like(like)
    for joint, torque in change.items():
        told[:, joint] = torque
    return told


def largest(motion: Motion) -> float:
    """Largest torque of the bodies."""
    return float(np.abs(motion.load).max())
