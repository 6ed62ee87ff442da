"""A process says at a training sample what remained there, and nothing where half of its variance is open."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.models.corrected.remainder.process import (
    KNOWN,
    ProcessRemainder,
    matern,
    process_inputs,
    taken_away,
)

NOISE = 0.01


def one_place(weights: list[float], noise: float = NOISE, length: float = 1.0) -> ProcessRemainder:
    """Training samples that all lie at q = v = a = 0 of one joint."""
    m = len(weights)
    centre, ones = process_inputs(*np.zeros((3, 1, 1)))[0], np.ones(1)
    return ProcessRemainder(
        centre, np.ones(4), np.zeros((m, 4)), np.ones((m, 1), dtype=bool), np.array(weights)[:, None], length * ones,
        noise * ones, ones,
    )  # fmt: skip


def at_speed(process: ProcessRemainder, *speeds: float) -> np.ndarray:
    v = np.array(speeds)[:, None]
    return process.torque(np.zeros_like(v), v, np.zeros_like(v))[:, 0]


def test_at_a_training_sample_it_says_what_remained_there_and_far_away_nothing() -> None:
    np.testing.assert_allclose(at_speed(one_place([2.0]), 0.0, 3.0), [2.0, 0.0])


def test_between_it_says_the_kernel_s_part_as_long_as_half_of_its_variance_is_known() -> None:
    speeds = np.linspace(0.0, 2.0, 50)
    k = matern(speeds)
    known = k**2 * k**2 / (k**2 + NOISE) > KNOWN
    assert known.any()
    assert not known.all()
    np.testing.assert_allclose(at_speed(one_place([2.0]), *speeds), np.where(known, 2.0 * k, 0.0))


def test_a_single_noisy_sample_is_not_enough_and_many_are() -> None:
    assert at_speed(one_place([2.0], noise=2.0), 0.0)[0] == 0.0
    assert at_speed(one_place([0.5] * 4, noise=2.0), 0.0)[0] == pytest.approx(2.0)


@pytest.mark.parametrize("n", [1, 5])
def test_the_share_that_is_taken_away_is_exact_at_one_place(n: int) -> None:
    exact = np.ones(n) @ np.linalg.solve(np.ones((n, n)) + NOISE * np.eye(n), np.ones(n))
    assert taken_away(np.ones((1, n)), NOISE)[0] == pytest.approx(exact)


@pytest.mark.parametrize("gap", [0.05, 0.25, 1.0])
@pytest.mark.parametrize("noise", [0.003, 0.1, 1.0, 3.0])
def test_along_a_line_it_speaks_only_where_nearly_half_is_known_indeed(gap: float, noise: float) -> None:
    places, asked = np.arange(0.0, 10.0, gap), np.linspace(-1.0, 11.0, 301)
    k = matern(np.abs(asked[:, None] - places))
    inner = matern(np.abs(places[:, None] - places)) + noise * np.eye(len(places))
    exact = np.sum(k * np.linalg.solve(inner, k.T).T, axis=1)
    assert np.all(exact[taken_away(k, noise) > KNOWN] > 0.8 * KNOWN)


def test_samples_at_which_a_joint_rests_are_no_place_of_it() -> None:
    process = one_place([2.0, 0.0])
    resting = ProcessRemainder(**{**vars(process), "counted": np.array([[False], [False]]), "share": np.zeros(1)})
    assert at_speed(resting, 0.0)[0] == 0.0
