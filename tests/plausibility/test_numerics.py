"""Derivatives, search and motions against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.plausibility.motions import DURATION, dimension, motions
from lagnet.plausibility.quantities import derivatives
from lagnet.plausibility.search import worst_point
from lagnet.plausibility.settings import CheckSettings
from lagnet.plausibility.subject import Subject
from lagnet.plausibility.torque_function import TorqueFunction
from lagnet.rigid_body.random_arm import random_arm

DIFFERENCES = 1e-10  # sixth-order differences of functions of order one at step 0.01


@pytest.fixture(scope="module")
def subject() -> Subject:
    return Subject(random_arm(3, 2, ("revolute",)))


def test_gradient_of_sines(subject: Subject):
    q = np.random.default_rng(0).normal(size=(5, 3))
    slope, error = derivatives.position_gradient(subject, lambda x: np.sin(2 * x), q)
    expected = np.zeros((5, 3, 3))
    expected[:, np.arange(3), np.arange(3)] = 2 * np.cos(2 * q)
    np.testing.assert_allclose(slope, expected, atol=DIFFERENCES)
    assert np.all(error < 1e-7)


def test_kink_is_told_as_error(subject: Subject):
    _, error = derivatives.position_gradient(subject, np.abs, np.full((1, 3), 0.004))
    assert np.all(error[0, np.arange(3), np.arange(3)] > 1e-3)


def test_christoffel_torque_is_pinocchios(subject: Subject):
    q, v, _ = subject.random(20)
    gradient, _ = derivatives.position_gradient(subject, subject.mass_matrix, q)
    own = subject.model.coriolis_torque(q, v)
    np.testing.assert_allclose(derivatives.christoffel_torque(gradient, v), own, atol=1e-8 * np.abs(own).max())


def test_rate_of_mass_matrix_is_c_plus_its_transpose(subject: Subject):
    q, v, _ = subject.random(20)
    rate, _ = derivatives.along(subject, subject.mass_matrix, q, v)
    C = subject.model.coriolis_matrix(q, v)
    np.testing.assert_allclose(rate, C + C.transpose(0, 2, 1), atol=1e-8 * np.abs(C).max())


def test_local_search_climbs_beyond_the_samples(subject: Subject):
    top = np.full(4, 0.317)
    few = Subject(subject.model, settings=CheckSettings(samples=8, starts=2, iterations=30))
    worst = worst_point(few, 4, lambda x: np.exp(-np.sum((x - top) ** 2, axis=1)))
    assert worst.value > worst.sampled
    np.testing.assert_allclose(worst.point, top, atol=1e-3)


def test_search_stays_in_the_box(subject: Subject):
    worst = worst_point(subject, 2, lambda x: x.sum(axis=1))
    np.testing.assert_allclose(worst.point, [1.0, 1.0])


def test_motions_are_consistent_and_within_the_box(subject: Subject):
    points = np.random.default_rng(1).uniform(-1, 1, (4, dimension(subject)))
    motion = motions(subject, points)
    box = subject.ranges
    assert np.all(motion.q <= box.upper + 1e-12)
    assert np.all(motion.q >= box.lower - 1e-12)
    assert np.all(np.abs(motion.v) <= box.velocity + 1e-12)
    moved = motion.integrals(motion.v[:, :, 0])
    np.testing.assert_allclose(moved, motion.ends[0][:, :, 0] - motion.ends[0][:, :1, 0], atol=1e-12)
    sped = motion.integrals(motion.a[:, :, 1])
    np.testing.assert_allclose(sped, motion.ends[1][:, :, 1] - motion.ends[1][:, :1, 1], atol=1e-12)
    assert motion.weights.sum() == pytest.approx(DURATION)


def test_rounding_of_double_precision_is_seen(subject: Subject):
    assert subject.rounding < 1e-13
    coarse = TorqueFunction(lambda q, v, a: subject.model.inverse_dynamics(q, v, a).astype(np.float32), "abc")
    assert 1e-9 < Subject(coarse).rounding <= 1e-6
