"""ε is a sum of parts, fades where a joint may rest, and comes back from plain values as it was."""

from __future__ import annotations

import json
from dataclasses import dataclass

import numpy as np
import pytest

from lagnet.models.corrected.remainder.files import remainder_as_json, remainder_from_json
from lagnet.models.corrected.remainder.learned import TOGETHER, LearnedRemainder, angles, squared_distances
from lagnet.models.corrected.remainder.network import OWN, NetworkRemainder
from lagnet.models.corrected.remainder.process import ProcessRemainder

N = 2
SLOW = np.array([0.1, 0.2])


@dataclass(frozen=True, eq=False)
class Constant:
    """A part that gives one torque everywhere."""

    torques: np.ndarray
    share: np.ndarray

    def torque(self, q, v, a):
        return np.zeros_like(q) + self.torques * self.share


def both_parts(seed: int = 0) -> LearnedRemainder:
    """Networks and a process of random weights at two joints, of which the process is used at the second alone."""
    g = np.random.default_rng(seed)
    n, m = 2 * N + OWN, 4 * N
    weights = (g.normal(size=(3, N, n, 4)), g.normal(size=(3, N, 4, 1)))
    biases = (g.normal(size=(3, N, 4)), g.normal(size=(3, N, 1)))
    anchors = g.normal(size=(N, 5, n))
    networks = NetworkRemainder(
        g.normal(size=(N, n)),
        np.full((N, n), 2.0),
        weights,
        biases,
        np.array([0.5, 1.0]),
        anchors,
        np.full(N, 9.0),
        SLOW,
    )
    counted = np.array([[True, True], [True, False], [True, True]])
    process = ProcessRemainder(
        np.zeros(m), np.ones(m), g.normal(size=(3, m)), counted, g.normal(size=(3, N)) * counted, np.array([3.0, 4.0]),
        np.array([0.1, 0.2]), np.array([0.0, 1.0]),
    )  # fmt: skip
    return LearnedRemainder((networks, process), SLOW)


def motion(n: int = 50):
    g = np.random.default_rng(1)
    return g.normal(size=(n, N)), g.normal(size=(n, N)), g.normal(size=(n, N))


def test_parts_add_and_a_joint_that_may_rest_is_given_its_speed_over_the_slow_one() -> None:
    parts = (Constant(np.array([1.0, 2.0]), np.ones(N)), Constant(np.array([10.0, 20.0]), np.array([1.0, 0.0])))
    v = np.array([[0.0, 1.0], [0.05, 0.1], [-0.1, -9.0]])
    expected = [[0.0, 2.0], [5.5, 1.0], [11.0, 2.0]]
    epsilon = LearnedRemainder(parts, SLOW)
    np.testing.assert_allclose(epsilon.torque(np.zeros_like(v), v, np.zeros_like(v)), expected)
    np.testing.assert_array_equal(epsilon.acts_on, [True, True])


def test_many_samples_are_judged_one_by_one() -> None:
    epsilon, (q, v, a) = both_parts(), motion(2 * TOGETHER + 3)
    together, rows = epsilon.torque(q, v, a), [0, TOGETHER - 1, TOGETHER, 2 * TOGETHER, 2 * TOGETHER + 2]
    np.testing.assert_allclose(together[rows], epsilon.torque(q[rows], v[rows], a[rows]), atol=1e-12)
    assert np.any(together[rows] != 0.0)


def test_a_turn_more_is_the_same_place() -> None:
    q = np.random.default_rng(2).normal(size=(7, N))
    np.testing.assert_allclose(angles(q + 2.0 * np.pi), angles(q), atol=1e-14)


def test_distances_are_those_of_pairs() -> None:
    g = np.random.default_rng(3)
    x, y = g.normal(size=(4, 3)), g.normal(size=(5, 3))
    np.testing.assert_allclose(squared_distances(x, y), np.sum((x[:, None] - y[None]) ** 2, axis=2), atol=1e-12)
    assert np.all(squared_distances(1e8 + x, 1e8 + x) >= 0.0)


def test_it_comes_back_from_its_file() -> None:
    epsilon, (q, v, a) = both_parts(), motion()
    back = remainder_from_json(json.loads(json.dumps(remainder_as_json(epsilon))), N)
    np.testing.assert_array_equal(back.torque(q, v, a), epsilon.torque(q, v, a))
    assert remainder_as_json(None) is None
    assert remainder_from_json(None, N) is None


DAMAGES = {
    "no parts": lambda e: e.update(parts=[]),
    "many parts": lambda e: e.update(parts=e["parts"] * 9),
    "an unknown part": lambda e: e["parts"][0].update(kind="oracle"),
    "no width": lambda e: e.update(slow=[0.1, 0.0]),
    "another arm": lambda e: e["parts"][0].update(share=[1.0]),
    "flat biases": lambda e: e["parts"][0].update(biases=[1.0, 2.0]),
    "no anchors": lambda e: e["parts"][0].update(anchors=[]),
    "two outputs": lambda e: e["parts"][0].update(
        weights=[np.ones((1, N, 2 * N + OWN, 2)).tolist()], biases=[np.ones((1, N, 2)).tolist()]
    ),
    "not a number": lambda e: e["parts"][1]["weights"][0].__setitem__(0, float("nan")),
    "no length": lambda e: e["parts"][1].update(length=[1.0, -1.0]),
    "a joint without samples": lambda e: e["parts"][1].update(counted=[[1, 0]] * 3),
}  # fmt: skip


@pytest.mark.parametrize("damage", DAMAGES.values(), ids=DAMAGES)
def test_a_damaged_entry_is_refused(damage) -> None:
    entry = json.loads(json.dumps(remainder_as_json(both_parts())))
    damage(entry)
    with pytest.raises((KeyError, TypeError, ValueError)):
        remainder_from_json(entry, N)


def test_one_of_an_earlier_version_is_refused_with_a_way_out() -> None:
    with pytest.raises(ValueError, match="layers='identified'"):
        remainder_from_json({"centre": [0.0], "share": [1.0]}, N)
