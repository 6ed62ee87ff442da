"""Networks of ε are used near their training motion and fade to nothing beyond it, and where members disagree."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.models.corrected.remainder.network import BEYOND, OWN, NetworkRemainder, network_inputs

REACH = 2.0


def constant(torques: list[float], share=(1.0,), reach: float = REACH) -> NetworkRemainder:
    """A committee whose members give one torque each at every sample, trained around q = v = a = 0."""
    n_dof, n = len(share), 2 * len(share) + OWN
    weights = (np.zeros((len(torques), n_dof, n, 1)),)
    biases = (np.repeat(np.array(torques)[:, None, None], n_dof, axis=1),)
    slow = np.full(n_dof, 1e9)  # the smooth sign stays at zero
    centre = network_inputs(*np.zeros((3, 1, n_dof)), slow)[:, 0]
    anchors, reaches = np.zeros((n_dof, 1, n)), np.full(n_dof, reach)
    return NetworkRemainder(centre, np.ones((n_dof, n)), weights, biases, np.array(share), anchors, reaches, slow)


def at_speed(epsilon: NetworkRemainder, *speeds: float) -> np.ndarray:
    v = np.zeros((len(speeds), epsilon.share.size))
    v[:, 0] = speeds
    return epsilon.torque(np.zeros_like(v), v, np.zeros_like(v))


def test_it_fades_between_its_reach_and_the_distance_beyond_which_it_is_silent() -> None:
    middle = REACH * (1.0 + BEYOND) / 2.0
    torque = at_speed(constant([3.0, 3.0]), 0.0, REACH, middle, BEYOND * REACH, 100.0 * REACH)[:, 0]
    np.testing.assert_allclose(torque, [3.0, 3.0, 1.5, 0.0, 0.0], atol=1e-6)


def test_the_speed_of_another_joint_is_none_of_its_inputs() -> None:
    torque = at_speed(constant([3.0, 3.0], share=(1.0, 1.0)), 100.0 * REACH)
    np.testing.assert_allclose(torque, [[0.0, 3.0]], atol=1e-6)


def test_members_that_disagree_are_not_believed() -> None:
    assert at_speed(constant([3.0, 3.0]), 0.0)[0, 0] == pytest.approx(3.0)
    assert at_speed(constant([4.0, 2.0]), 0.0)[0, 0] == pytest.approx(3.0 * 9.0 / 10.0)  # mean² / (mean² + spread²)
    assert at_speed(constant([3.0, -3.0]), 0.0)[0, 0] == 0.0


def test_a_joint_is_given_its_share() -> None:
    np.testing.assert_allclose(at_speed(constant([3.0, 3.0], share=(0.5, 0.0)), 0.0), [[1.5, 0.0]])
