"""The fixed point of the evidence agrees with dense algebra, and what is excluded is exactly zero."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.identified.design import Design, Group, JointRows
from lagnet.diagnosis.identified.equations import joint_equations
from lagnet.diagnosis.identified.evidence import EXCLUDED, Ridge, fit_ridge, solve_beside

BODIES, OWN, N = 4, 3, 200
TRUE = np.array([1.0, -0.5, 0.0, 0.3, 2.0, 0.0, -1.0, 0.5, 0.0, 0.7])
NOISE = 0.1
INEFFICIENCY = 3.0


@pytest.fixture
def design() -> Design:
    """Two joints over shared unknowns and three of their own each."""
    rng, joints = np.random.default_rng(5), []
    for j in range(2):
        unknowns = np.concatenate([np.arange(BODIES), BODIES + OWN * j + np.arange(OWN)])
        columns = rng.standard_normal((N, unknowns.size))
        target = columns @ TRUE[unknowns] + NOISE * rng.standard_normal(N)
        joints.append(JointRows(columns, target, rng.random(N) > 0.1, unknowns))
    own = [Group(f"own {j}", BODIES + OWN * j + np.arange(OWN), free=j == 1, joint=j) for j in range(2)]
    groups = (Group("bodies", np.arange(BODIES), False), *own)
    return Design(tuple(joints), groups, (), BODIES, np.ones(TRUE.size), np.zeros(N, dtype=int))


def rows_of(design: Design, found: Ridge) -> tuple[np.ndarray, np.ndarray]:
    """All valid rows over all unknowns, each divided by its standard deviation."""
    tables, targets = [], []
    for joint, variance in zip(design.joints, found.variance, strict=True):
        table = np.zeros((N, design.n_unknowns))
        table[:, joint.unknowns] = joint.columns
        weight = joint.valid / np.sqrt(INEFFICIENCY * variance)
        tables.append(table * weight[:, None])
        targets.append(joint.target * weight)
    return np.vstack(tables), np.concatenate(targets)


def test_the_fit_is_the_posterior_of_its_own_precisions(design) -> None:
    found = fit_ridge(design, joint_equations(design), INEFFICIENCY)
    table, target = rows_of(design, found)
    dense = np.linalg.inv(table.T @ table + np.diag(found.precision))
    np.testing.assert_allclose(found.covariance, dense, rtol=1e-6, atol=1e-12)
    np.testing.assert_allclose(found.x, dense @ table.T @ target, rtol=1e-6)
    np.testing.assert_allclose(found.x, TRUE, atol=0.05)
    np.testing.assert_allclose(found.variance, NOISE**2, rtol=0.3)


def test_an_excluded_group_is_zero_and_the_rest_is_fitted_as_if_it_were_not_there(design) -> None:
    found = fit_ridge(design, joint_equations(design), INEFFICIENCY, excluded=frozenset({1}))
    without = fit_ridge(design.without(np.arange(BODIES, BODIES + OWN)), joint_equations(design), INEFFICIENCY)
    gone = slice(BODIES, BODIES + OWN)
    assert not found.x[gone].any()
    assert not found.covariance[gone].any()
    assert np.all(found.precision[gone] == EXCLUDED)
    np.testing.assert_allclose(found.x, without.x, rtol=1e-10)


@pytest.mark.parametrize("excluded", [frozenset(), frozenset({1}), frozenset({0, 1, 2})], ids=["all", "some", "none"])
def test_other_rows_have_the_posterior_mean_for_given_precisions(design, excluded) -> None:
    found = fit_ridge(design, joint_equations(design), INEFFICIENCY, excluded=excluded)
    np.testing.assert_allclose(solve_beside(design, joint_equations(design), INEFFICIENCY, found), found.x, rtol=1e-9)
    rows, (table, target) = slice(0, N // 2), rows_of(design, found)
    half = np.tile(np.arange(N) < N // 2, 2)
    fitted = np.flatnonzero(found.precision < EXCLUDED)
    own, expected = table[half][:, fitted], np.zeros(design.n_unknowns)
    expected[fitted] = np.linalg.solve(own.T @ own + np.diag(found.precision[fitted]), own.T @ target[half])
    of_half = solve_beside(design, joint_equations(design, rows), INEFFICIENCY, found)
    np.testing.assert_allclose(of_half, expected, rtol=1e-6, atol=1e-12)


def test_a_joint_without_torque_or_samples_changes_nothing(design) -> None:
    still = design.joints[1]
    still = JointRows(still.columns, 0.0 * still.target, np.zeros(N, dtype=bool), still.unknowns)
    one = Design((design.joints[0], still), design.groups, (), BODIES, design.scale, design.piece)
    found = fit_ridge(one, joint_equations(one), INEFFICIENCY)
    assert np.all(np.isfinite(found.x))
    np.testing.assert_allclose(found.x[: BODIES + OWN], TRUE[: BODIES + OWN], atol=0.1)


def test_what_motion_does_not_tell_apart_has_no_huge_weights(design) -> None:
    """Dry friction and an offset of a joint that turns one way but for a moment, at which something else acts."""
    joint = design.joints[1]
    columns, target = joint.columns.copy(), joint.target.copy()
    columns[:, -1] = 1.0
    columns[:, -2] = np.where(np.arange(N) == 7, 0.97, 1.0)
    target[7] += 3.0
    nearly = JointRows(columns, target, np.ones(N, dtype=bool), joint.unknowns)
    two = Design((design.joints[0], nearly), design.groups, (), BODIES, design.scale, design.piece)
    found = fit_ridge(two, joint_equations(two), INEFFICIENCY)
    own = found.x[joint.unknowns[-2:]]
    assert np.all(np.abs(own) < 10.0)
    assert own.sum() == pytest.approx(
        target.mean() - columns[:, :-2].mean(axis=0) @ found.x[joint.unknowns[:-2]], abs=0.1
    )
