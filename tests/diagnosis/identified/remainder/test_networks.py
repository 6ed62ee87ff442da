"""Networks learn what hangs on a joint's own motion, and are judged by blocks that each has not seen."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.identified.remainder.networks import _extent, _share, _without_one, fit_networks
from lagnet.diagnosis.identified.remainder.samples import RemainderSamples
from lagnet.diagnosis.identified.remainder.settings import RemainderSettings

N, SAMPLES = 2, 600
NOISE = 0.05
SETTINGS = RemainderSettings()


def samples(law, seed: int = 0) -> RemainderSamples:
    time = np.linspace(0.0, 40.0, SAMPLES)[:, None]
    omega = np.array([0.7, 1.1]) * (1.0 + 0.3 * np.sin(0.05 * time))
    q, v = np.sin(omega * time), omega * np.cos(omega * time)
    a = np.gradient(v, time[:, 0], axis=0)
    left = law(q, v, a) + NOISE * np.random.default_rng(seed).normal(size=q.shape)
    return RemainderSamples(q, v, a, left, np.abs(v) > 0.05, np.full(N, 0.05))


def stribeck(q, v, a):
    return np.column_stack([np.sign(v[:, 0]) * np.exp(-((v[:, 0] / 0.3) ** 2)), np.zeros(len(v))])


def test_a_law_of_the_joint_s_own_speed_is_learned() -> None:
    known = samples(stribeck)
    networks = fit_networks(known, 0, SETTINGS)
    assert networks.share[0] > 0.5
    assert networks.share[1] == 0.0
    left = (known.left - networks.torque(known.q, known.v, known.a))[known.counts[:, 0], 0]
    assert np.mean(left**2) < 0.2 * known.power()[0]


def test_nothing_is_taken_of_noise() -> None:
    assert fit_networks(samples(lambda q, v, a: np.zeros_like(q)), 0, SETTINGS) is None


def test_each_member_leaves_its_block_out() -> None:
    counts, blocks = np.ones((6, N)), np.array_split(np.arange(6), 3)
    weight = _without_one(counts, blocks)
    np.testing.assert_array_equal(weight[1, :, 0], [1, 1, 0, 0, 1, 1])
    np.testing.assert_array_equal(weight.sum(axis=0), np.full((6, N), 2.0))


@pytest.mark.parametrize(
    ("own", "others", "expected"),
    [(1.0, 9.0, 1.0), (2.0, 9.0, 0.5), (0.0, 9.0, 0.0), (-1.0, 9.0, 0.0)],
    ids=["right", "twice too much", "silent", "the wrong way"],
)
def test_the_share_is_what_the_member_that_has_not_seen_a_block_says_of_it(own, others, expected) -> None:
    target, blocks = np.arange(1.0, 9.0)[:, None], np.array_split(np.arange(8), 4)
    told = others * np.ones((4, 1, 8))
    for k, block in enumerate(blocks):
        told[k, 0, block] = own * target[block, 0]
    assert _share(told, target, np.ones((8, 1)), blocks, 0.05)[0] == pytest.approx(expected)


def test_a_gain_in_one_block_alone_is_none() -> None:
    target, blocks = np.r_[10.0, 10.0, np.ones(6)][:, None], np.array_split(np.arange(8), 4)
    told = np.tile(np.r_[10.0, 10.0, -np.ones(6)], (4, 1))[:, None]
    assert _share(told, target, np.ones((8, 1)), blocks, 0.05)[0] == 0.0


def test_the_reach_covers_the_motion_and_rest_is_no_part_of_it() -> None:
    x = np.random.default_rng(0).normal(size=(1, 500, 3))
    counts = (x[0, :, :1] > 0.0) & np.ones((500, 1), dtype=bool)
    anchors, reach = _extent(x, counts, 50)
    assert np.all(anchors[0][:, 0] > 0.0)
    nearest = np.linalg.norm(x[0][counts[:, 0]][:, None] - anchors[0][None], axis=2).min(axis=1)
    assert np.mean(nearest <= reach[0] + 1e-12) == pytest.approx(0.99, abs=0.01)
