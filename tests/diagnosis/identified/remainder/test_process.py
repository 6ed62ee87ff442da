"""The process learns what comes again with the state of the arm, and takes nothing of noise."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.identified.remainder.process import LENGTHS, NOISES, _Spectrum, fit_process
from lagnet.diagnosis.identified.remainder.samples import RemainderSamples
from lagnet.diagnosis.identified.remainder.settings import RemainderSettings
from lagnet.models.corrected.remainder.process import matern

N, SAMPLES = 3, 400
NOISE = 0.05  # [N m] beside a torque of about 1
SETTINGS = RemainderSettings()


def path(phase: float = 0.0, tempo: float = 1.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """q, v, a of sines that do not close within the samples."""
    time = np.linspace(0.0, 12.0, SAMPLES)[:, None]
    omega = tempo * np.array([0.7, 1.1, 1.9])
    angle = omega * time + phase * np.arange(1, N + 1)
    return np.sin(angle), omega * np.cos(angle), -(omega**2) * np.sin(angle)


def torque(q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Of the first joint alone, over what its own motion does not tell."""
    return np.column_stack([v[:, 1] * a[:, 2], np.zeros((len(q), N - 1))])


def samples(seed: int, law=torque, counts=None) -> RemainderSamples:
    q, v, a = path()
    left = law(q, v, a) + NOISE * np.random.default_rng(seed).normal(size=q.shape)
    counts = np.ones(q.shape, dtype=bool) if counts is None else counts
    return RemainderSamples(q, v, a, left, counts, np.full(N, 0.01))


def test_motion_that_comes_again_meets_the_torque_that_remained_there() -> None:
    process = fit_process(samples(0), SETTINGS)
    np.testing.assert_array_equal(process.share, [1.0, 0.0, 0.0])
    q, v, a = path()
    left = torque(q, v, a) - process.torque(q, v, a)
    assert np.sqrt(np.mean(left[:, 0] ** 2)) < NOISE
    assert np.all(left[:, 1:] == 0.0)


def test_motion_elsewhere_is_left_alone() -> None:
    process = fit_process(samples(0), SETTINGS)
    assert np.mean(process.torque(*path(phase=2.0, tempo=3.0)) != 0.0) < 0.02


def test_nothing_is_taken_of_noise() -> None:
    assert fit_process(samples(1, law=lambda q, v, a: np.zeros_like(q)), SETTINGS) is None


def test_nothing_is_taken_where_no_joint_moves() -> None:
    assert fit_process(samples(1, counts=np.zeros((SAMPLES, N), dtype=bool)), SETTINGS) is None


def test_samples_at_rest_are_not_learned_from() -> None:
    counts = np.ones((SAMPLES, N), dtype=bool)
    counts[::2, 0] = False
    whole = samples(0, counts=counts)
    process = fit_process(whole, SETTINGS)
    wrong = whole.left.copy()
    wrong[::2, 0] = 1e6
    again = fit_process(RemainderSamples(whole.q, whole.v, whole.a, wrong, counts, whole.slow), SETTINGS)
    np.testing.assert_array_equal(process.weights[:, 0], again.weights[:, 0])


@pytest.mark.parametrize("noise", [NOISES[0], NOISES[-1]])
def test_evidence_and_gain_are_those_of_the_written_out_process(noise: float) -> None:
    g = np.random.default_rng(2)
    x, y, n = g.normal(size=(12, 2)), g.normal(size=12), 12
    kernel = matern(np.sqrt(np.sum((x[:, None] - x[None]) ** 2, axis=2)) / LENGTHS[-1])
    values, vectors = np.linalg.eigh(kernel)
    fit = _Spectrum(LENGTHS[-1], values, vectors).fit(y, noise)
    inner = kernel + noise * np.eye(n)
    np.testing.assert_allclose(fit.weights, np.linalg.solve(inner, y), rtol=1e-6)
    size = y @ np.linalg.solve(inner, y) / n
    assert fit.evidence == pytest.approx(-0.5 * n * np.log(size) - 0.5 * np.linalg.slogdet(inner)[1])
    unseen = []
    for i in range(n):
        rest = np.arange(n) != i
        unseen.append(y[i] - kernel[i, rest] @ np.linalg.solve(inner[np.ix_(rest, rest)], y[rest]))
    assert fit.gain == pytest.approx(1.0 - np.sum(np.square(unseen)) / np.sum(y**2))
