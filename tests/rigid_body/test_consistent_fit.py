"""Least squares over real bodies: exact where data come from one, best where they do not, the prior where silent."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize

from lagnet.rigid_body.consistent_fit import consistent_path, fit_consistent
from lagnet.rigid_body.inertia import (
    from_log_cholesky,
    is_physically_consistent,
    log_cholesky_jacobian,
    parameters_of_body,
    pseudo_inertia,
    to_log_cholesky,
)
from lagnet.rigid_body.random_arm import random_arm

RECOVERY = 1e-6  # noise-free torques of the same arm, relative
PRIOR = parameters_of_body(2.0, np.zeros(3), np.eye(3) * 0.02)


def problem(robot, n=300, seed=0):
    q, v, a = np.random.default_rng(seed).normal(size=(3, n, robot.n_dof))
    regressor = robot.joint_torque_regressor(q, v, a).reshape(-1, 10 * robot.n_dof)
    return regressor, regressor @ robot.inertial_parameters().ravel()


def test_an_arm_is_recovered_with_all_bodies_real():
    robot = random_arm(5, 1)
    regressor, tau = problem(robot)
    fit = fit_consistent(regressor.T @ regressor, regressor.T @ tau, np.tile(PRIOR, (5, 1)))
    assert fit.shape == (5, 10)
    assert is_physically_consistent(fit).all()
    assert np.abs(regressor @ fit.ravel() - tau).max() < RECOVERY * np.abs(tau).max()


def test_one_body_is_recovered():
    robot = random_arm(6, 2, kinds=("revolute",))
    regressor, _ = problem(robot)
    last, truth = regressor[:, 50:], robot.inertial_parameters()[5]
    fit = fit_consistent(last.T @ last, last.T @ (last @ truth), PRIOR)
    assert np.abs(last @ (fit - truth)).max() < RECOVERY * np.abs(last @ truth).max()


@pytest.mark.parametrize("seed", range(5))
def test_the_best_real_body_for_unreal_data_is_the_global_minimum(seed):
    generator = np.random.default_rng(seed)
    factor = generator.normal(size=(40, 10))
    gram = factor.T @ factor
    moment = gram @ generator.normal(size=10)  # no body has these parameters
    weight = 1e-3 * float(moment @ np.linalg.solve(gram, moment))
    fit = fit_consistent(gram, moment, PRIOR, weight)
    assert is_physically_consistent(fit)
    assert cost(fit, gram, moment, weight) <= best_by_log_cholesky(gram, moment, weight) + 1e-6 * weight


def cost(parameters, gram, moment, weight):
    ratio = pseudo_inertia(parameters) @ np.linalg.inv(pseudo_inertia(PRIOR))
    distance = np.trace(ratio) - np.log(np.linalg.det(ratio)) - 4
    return 0.5 * parameters @ gram @ parameters - moment @ parameters + weight * distance


def best_by_log_cholesky(gram, moment, weight):
    """The same minimum by another road: quasi-Newton without constraints in log-Cholesky coordinates."""

    def value(theta):
        return cost(from_log_cholesky(theta), gram, moment, weight)

    return minimize(value, to_log_cholesky(PRIOR), method="BFGS", options={"gtol": 1e-8, "maxiter": 2000}).fun


def test_what_the_data_leave_open_stays_at_the_prior():
    gram, moment = np.zeros((10, 10)), np.zeros(10)
    gram[0, 0], moment[0] = 1.0, 3.0  # the data know the mass alone: 3 kg
    fit = fit_consistent(gram, moment, PRIOR)
    assert fit[0] == pytest.approx(3.0, rel=1e-6)
    assert fit[1:4] == pytest.approx(np.zeros(3), abs=1e-9)
    assert fit[4] == pytest.approx(PRIOR[4], rel=1e-6)


def test_no_data_give_the_prior():
    assert fit_consistent(np.zeros((10, 10)), np.zeros(10), PRIOR) == pytest.approx(PRIOR)


@pytest.mark.parametrize("falls", [10.0, 3.0, 100.0])
def test_along_a_path_of_weights_the_bodies_are_those_of_each_weight_alone(falls):
    robot = random_arm(2, seed=4, kinds=("revolute",))
    rows, torque = problem(robot)
    torque = torque + 0.1 * np.random.default_rng(2).normal(size=torque.shape)
    gram, moment, prior = rows.T @ rows, rows.T @ torque, np.tile(PRIOR, (2, 1))
    weights = 10.0 / falls ** np.arange(3)
    for bodies, weight in zip(consistent_path(gram, moment, prior, weights), weights, strict=True):
        np.testing.assert_allclose(bodies, fit_consistent(gram, moment, prior, weight), rtol=1e-6, atol=1e-9)


def test_the_slope_used_by_other_fits_is_that_of_the_cost():
    theta = to_log_cholesky(PRIOR) + 0.1
    target = np.linspace(1, 2, 10)
    steps = np.eye(10) * 1e-6
    slope = [(from_log_cholesky(theta + e) - from_log_cholesky(theta - e)) @ target / 2e-6 for e in steps]
    assert np.allclose(log_cholesky_jacobian(theta).T @ target, slope, rtol=1e-5, atol=1e-7)


def test_problems_that_do_not_fit_are_told():
    with pytest.raises(ValueError, match="do not fit a prior"):
        fit_consistent(np.eye(10), np.zeros(9), PRIOR)
    with pytest.raises(ValueError, match="prior body 0 is not physically consistent"):
        fit_consistent(np.eye(10), np.zeros(10), -PRIOR)
    with pytest.raises(ValueError, match="expected a positive number"):
        fit_consistent(np.eye(10), np.ones(10), PRIOR, weight=0.0)
