"""ε is used near its training motion and fades to nothing beyond it, and where members disagree or nothing gained."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.models.corrected.remainder import BEYOND, LearnedRemainder, features

REACH = 2.0


def constant(torques: list[float], share=(1.0,), reach: float = REACH) -> LearnedRemainder:
    """An ensemble whose members give one torque each at every sample, trained around q = v = a = 0 of one joint."""
    n_dof = len(share)
    weights = (np.zeros((len(torques), 4 * n_dof, n_dof)),)
    biases = (np.repeat(np.array(torques)[:, None], n_dof, axis=1),)
    centre = features(*np.zeros((3, 1, n_dof)))[0]
    anchors = np.zeros((1, 4 * n_dof))
    return LearnedRemainder(centre, np.ones(4 * n_dof), weights, biases, np.array(share), anchors, reach)


def at_speed(epsilon: LearnedRemainder, *speeds: float) -> np.ndarray:
    v = np.array(speeds)[:, None] * np.ones(epsilon.share.size)
    v[:, 1:] = 0.0
    return epsilon.torque(np.zeros_like(v), v, np.zeros_like(v))


def test_it_fades_between_its_reach_and_the_distance_beyond_which_it_is_silent() -> None:
    middle = REACH * (1.0 + BEYOND) / 2.0
    torque = at_speed(constant([3.0, 3.0]), 0.0, REACH, middle, BEYOND * REACH, 100.0 * REACH)[:, 0]
    np.testing.assert_allclose(torque, [3.0, 3.0, 1.5, 0.0, 0.0], atol=1e-12)


def test_members_that_disagree_are_not_believed() -> None:
    assert at_speed(constant([3.0, 3.0]), 0.0)[0, 0] == pytest.approx(3.0)
    assert at_speed(constant([4.0, 2.0]), 0.0)[0, 0] == pytest.approx(3.0 * 9.0 / 10.0)  # mean² / (mean² + spread²)
    assert at_speed(constant([3.0, -3.0]), 0.0)[0, 0] == 0.0


def test_a_joint_is_given_its_share() -> None:
    np.testing.assert_allclose(at_speed(constant([3.0, 3.0], share=(0.5, 0.0)), 0.0), [[1.5, 0.0]])


def test_many_samples_are_judged_one_by_one() -> None:
    epsilon = constant([3.0, 3.0])
    speeds = np.linspace(0.0, 2.0 * REACH, 9000)  # more than are looked at together
    v = speeds[:, None]
    together = epsilon.torque(np.zeros_like(v), v, np.zeros_like(v))
    rows = [0, 4095, 4096, 8191, 8192, 8999]
    np.testing.assert_allclose(together[rows], at_speed(epsilon, *speeds[rows]), atol=1e-12)
