"""The remainder of a real arm along a plant's motion: its size, where it comes from, and what is taken out of it."""

from __future__ import annotations

import numpy as np
import pytest
from validation.concealed.reliability import named_against_the_odds, reliability
from validation.texture.remainders import RATE, Remainder, usual
from validation.texture.resample import SLOW, Texture, draw_texture, lay, without_listed_laws

N, DOF = 3000, 3


def motion(seed: int, n: int = N) -> np.ndarray:
    time, rng = np.arange(n) / RATE, np.random.default_rng(seed)
    phases = rng.uniform(0.0, 6.0, (4, DOF))
    return np.sum([np.sin((0.5 + 0.4 * k) * time[:, None] + phases[k]) for k in range(4)], axis=0)


def speed(q: np.ndarray) -> np.ndarray:
    return np.gradient(q, 1.0 / RATE, axis=0)


@pytest.fixture(scope="module")
def remainder() -> Remainder:
    """A torque that is large exactly where the first joint moves forward, and noise."""
    q = motion(0)
    v, a = speed(q), speed(speed(q))
    torque = 0.1 * (v[:, :1] > 0.0) * np.sin(40.0 * np.arange(N) / RATE)[:, None] * np.ones(DOF)
    torque += 1e-3 * np.random.default_rng(1).normal(size=(N, DOF))
    return Remainder("made", torque, np.hstack([v / usual([v]), a / usual([a])]))


def texture_of(remainder: Remainder) -> Texture:
    return Texture((remainder,), (0, 1, 2), 0.5)


def test_its_size_is_that_of_the_arm_and_its_scale(remainder) -> None:
    q, torque = motion(7), 20.0 * motion(8)
    texture = texture_of(remainder)
    found = np.sqrt(np.mean(lay(texture, q, torque, 0) ** 2, axis=0) / np.mean(torque**2, axis=0))
    np.testing.assert_allclose(found, texture.shares, rtol=0.25)


def test_it_lies_where_the_motion_is_alike_and_joints_stay_together(remainder) -> None:
    q = motion(7)
    laid = lay(texture_of(remainder), q, np.ones((N, DOF)), 0)
    forward = speed(q)[:, 0] > 0.0
    power = np.mean(laid**2, axis=1)
    assert power[forward].mean() > 2.0 * power[~forward].mean()
    assert np.all(np.corrcoef(laid.T) > 0.95)


def test_the_same_seed_gives_the_same_texture(remainder) -> None:
    q, torque = motion(7), motion(8)
    first, again, other = (lay(texture_of(remainder), q, torque, s) for s in (3, 3, 4))
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)


def test_no_offset_friction_rotor_or_gain_is_left_in_it() -> None:
    rng = np.random.default_rng(2)
    v, a, torque = rng.normal(size=(3, N, 1))
    listed = 0.3 + 0.2 * np.tanh(v / SLOW) + 0.1 * v - 0.4 * a + 0.05 * torque
    unlisted = np.sin(37.0 * np.arange(N) / RATE)[:, None]
    left = without_listed_laws(listed + unlisted, np.hstack([v, a]), torque)
    assert np.sqrt(np.mean((left - unlisted) ** 2)) < 0.1


def test_a_plant_with_more_joints_than_the_arm_uses_joints_again(remainder) -> None:
    texture = draw_texture([remainder], 7, (0.1, 1.0), seed=5)
    assert len(texture.joints) == 7
    assert {0, 1, 2} == set(texture.joints)
    assert 0.1 <= texture.scale <= 1.0


def test_names_are_counted_by_their_odds() -> None:
    rows = [(1.5, "named", "right"), (1.5, "named", "wrong"), (50.0, "named", "beside"), (-5.0, "tied", "right")]
    table = {tuple(row["log10_odds"]): row for row in reliability(rows)}
    assert (table[1.0, 2.0]["named"], table[1.0, 2.0]["named_right"]) == (2, 1)
    assert table[16.0, None]["named_right"] == 1
    assert table[None, -1.3]["tied_right"] == 1
    assert named_against_the_odds(rows, 1.3) == 1
