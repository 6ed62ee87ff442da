"""What recordings determine without a name: unlisted friction, wrong bodies, far models; nothing where nothing is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.diagnosis.conftest import Plant
from validation.far_models.plants import draw
from validation.far_models.study import FLOOR
from validation.real_arms.least_squares import LeastSquares

from lagnet.diagnosis.identified.design import FEWEST
from lagnet.diagnosis.identified.fit import identify
from lagnet.diagnosis.identified.verdict_entry import identified_as_json
from lagnet.diagnosis.problem.dry_friction import fit_sign_model
from lagnet.diagnosis.problem.problem import pose_problem
from lagnet.models.corrected.model import CorrectedModel
from lagnet.recordings.conditioning.condition import condition
from lagnet.rigid_body.inertia import is_physically_consistent
from lagnet.rigid_body.random_arm import random_arm

MUCH_LESS = 0.1  # of the nominal model's error, that the layer may leave of physics within its span
NO_WORSE = 1.1  # times the error of plain least squares


def posed(nominal, plant, seconds: float = 24.0):
    fit = condition([plant.record(1, seconds)])
    return pose_problem(nominal, fit, condition([plant.record(2, seconds)], fit.bandwidth))


def unseen_errors(problem, torque) -> np.ndarray:
    """Mean squared held-out error of each joint, for a function of a piece."""
    parts = [problem.reduce(p, p.tau - torque(p)) for p in problem.holdout]
    return np.mean(np.concatenate(parts) ** 2, axis=0)


def corrected(problem, found):
    return CorrectedModel(problem.nominal, (), problem.slow, straight=problem.straight, identified=found.layer)


def along(model):
    return lambda p: model.torque_along(p.time, p.q, p.v, p.a)


def usual_load(arm) -> np.ndarray:
    """Mean size of the gravity torque of each joint, at least half a newton metre."""
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (200, arm.n_dof))
    return np.maximum(np.abs(arm.gravity_torque(q)).mean(axis=0), 0.5)


def saturating_friction(arm):
    """Friction that no law of the catalogue has: it saturates over speed and grows with the load."""
    size = usual_load(arm)
    return lambda q, v, a, load: 0.2 * (size + 0.3 * np.abs(load)) * np.tanh(v / 0.4)


def wrong_bodies(arm, factors):
    return arm.with_inertial_parameters(arm.inertial_parameters() * np.asarray(factors)[:, None])


def test_friction_that_no_law_names_is_predicted() -> None:
    arm = random_arm(3, seed=5, kinds=("revolute",))
    problem = posed(arm, Plant(arm, [saturating_friction(arm)]))
    model = corrected(problem, identify(problem, ()))
    before, after = unseen_errors(problem, lambda p: p.load), unseen_errors(problem, along(model))
    assert np.all(after < MUCH_LESS * before)


@pytest.mark.parametrize("factors", [(1.0, 0.5, 2.0), (1.0, 2.0, 1e-6), (0.5, 0.5, 0.5)])
def test_far_models_end_no_worse_than_plain_least_squares(factors) -> None:
    arm = random_arm(3, seed=7, kinds=("revolute",))
    size = 10.0 * usual_load(arm)
    heavy = [lambda q, v, a, load: size * np.tanh(v / 0.02)]
    nominal = wrong_bodies(arm, factors)
    problem = posed(nominal, Plant(arm, heavy))
    model = corrected(problem, identify(problem, ()))
    plain = LeastSquares(nominal, problem)
    assert np.all(unseen_errors(problem, along(model)) <= NO_WORSE * unseen_errors(problem, plain.torque))


def test_nothing_is_identified_where_nothing_is_missing() -> None:
    arm = random_arm(3, seed=5, kinds=("revolute",))
    problem = posed(arm, Plant(arm))
    found = identify(problem, ())
    if found is not None:  # a joint may be told something within its noise, but never at a cost
        after = unseen_errors(problem, along(corrected(problem, found)))
        assert np.all(after < 1.05 * unseen_errors(problem, lambda p: p.load))


def test_identified_bodies_are_bodies_and_the_terms_add_up() -> None:
    arm = random_arm(3, seed=9, kinds=("revolute",))
    nominal = wrong_bodies(arm, (1.0, 1.4, 0.7))
    problem = posed(nominal, Plant(arm, [saturating_friction(arm)]))
    model = corrected(problem, identify(problem, ()))
    assert np.all(is_physically_consistent(model.inertial_parameters()))
    q, v, a = (np.random.default_rng(0).uniform(-1, 1, (20, 3)) for _ in range(3))
    mass = model.mass_matrix(q)
    assert np.linalg.eigvalsh(mass).min() > 0.0
    parts = np.einsum("nij,nj->ni", mass, a) + model.coriolis_torque(q, v) + model.gravity_torque(q)
    torque = model.inverse_dynamics(q, v, a)
    np.testing.assert_allclose(parts + model.residual_torque(q, v, a), torque, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(model.forward_dynamics(q, v, torque), a, rtol=1e-6, atol=1e-6)


def test_a_model_without_bodies_gets_terms_alone() -> None:
    arm = random_arm(2, seed=3, kinds=("revolute",))

    class Bodiless:
        joints, n_dof = arm.joints, arm.n_dof
        inverse_dynamics, mass_matrix = staticmethod(arm.inverse_dynamics), staticmethod(arm.mass_matrix)
        coriolis_torque, gravity_torque = staticmethod(arm.coriolis_torque), staticmethod(arm.gravity_torque)

    problem = posed(Bodiless(), Plant(arm, [saturating_friction(arm)]))
    found = identify(problem, ())
    assert found.layer.bodies is None
    after = unseen_errors(problem, along(corrected(problem, found)))
    assert np.all(after < MUCH_LESS * unseen_errors(problem, lambda p: p.load))


@pytest.mark.parametrize("held", [(0, 1), (1, 2), (2,)])
def test_joints_that_rest_are_not_made_worse(held: tuple[int, ...]) -> None:
    """Nothing is fitted where dry friction may take any value, and changed bodies load these joints all the same."""
    arm = random_arm(3, seed=8, kinds=("revolute",))
    plant = Plant(arm, [lambda q, v, a, load: usual_load(arm) * np.tanh(v / 0.02) * np.array([0.0, 1.0, 0.0])])
    fit = condition([plant.record(1, hold=held)])
    problem = pose_problem(arm, fit, condition([plant.record(2, hold=held)], fit.bandwidth))
    found = identify(problem, ())
    before = unseen_errors(problem, lambda p: p.load)
    after = before if found is None else unseen_errors(problem, along(corrected(problem, found)))
    assert np.all(after < 1.1 * before + 0.005**2 * problem.scale**2)


@pytest.mark.parametrize(("samples", "told"), [(FEWEST - 1, False), (5 * FEWEST, True)])
def test_a_joint_has_functions_where_enough_samples_of_it_move(samples: int, told: bool) -> None:
    arm, joint = random_arm(3, seed=5, kinds=("revolute",)), 1
    problem = posed(arm, Plant(arm, [saturating_friction(arm)]))
    (piece,) = problem.fit
    counts = piece.counts.copy()
    moving = np.flatnonzero(counts[:, joint])
    counts[:, joint] = False
    counts[moving[np.linspace(0, moving.size - 1, samples).round().astype(int)], joint] = True
    found = identify(replace(problem, fit=(piece.with_counts(counts),)), ())
    own = [w for t, w in zip(found.layer.terms, found.layer.weights, strict=True) if joint in t.rows]
    assert np.any(own) == told
    assert np.any(found.layer.weights)


def test_torque_in_phase_with_minus_a_is_speed_that_lags_and_no_inertia() -> None:
    arm = random_arm(3, seed=5, kinds=("revolute",))
    size = 3.0 * np.diagonal(arm.mass_matrix(np.zeros((1, 3)))[0])[2]

    def late(q, v, a, load):
        return np.outer(-size * a[:, 2], [0.0, 0.0, 1.0])

    problem = posed(arm, Plant(arm, [late]))
    found = identify(problem, ())
    model = corrected(problem, found)
    lags = {t.joint: w for t, w in zip(found.layer.terms, found.layer.weights, strict=True) if t.kind == "lag"}
    assert lags[2] > 0
    poses = np.concatenate([p.q for p in problem.fit])[::100]
    assert np.all(np.linalg.eigvalsh(model.mass_matrix(poses)) > 0)
    before, after = unseen_errors(problem, lambda p: p.load), unseen_errors(problem, along(model))
    assert after[2] < MUCH_LESS * before[2]
    assert f"At {arm.joints[2]} torque lags" in identified_as_json(found, arm, arm.joints)["words"]


@pytest.mark.parametrize("number", [3, 13])
def test_masses_that_are_missing_cost_no_joint_more_than_least_squares(number) -> None:
    plant = draw(number)
    fit = condition([plant.record(1)])
    problem = fit_sign_model(pose_problem(plant.nominal, fit, condition([plant.record(2)], fit.bandwidth)))
    squares = LeastSquares(plant.nominal, problem)
    ours, theirs = (
        unseen_errors(problem, torque) for torque in (along(corrected(problem, identify(problem, ()))), squares.torque)
    )
    assert np.all(ours <= np.maximum(NO_WORSE * theirs, FLOOR * problem.unseen_variance))


def test_no_friction_exceeds_the_load_that_it_is_told_of() -> None:
    """A brake whose pads are pressed by the load: in proportion to it, but not as a gear's friction can be."""
    arm = random_arm(3, seed=1, kinds=("revolute",), fixed=False)
    brake = Plant(arm, (lambda q, v, a, load: 3.0 * np.abs(load) * np.sign(v) * np.array([0.0, 0.0, 1.0]),))
    problem = posed(arm, brake)
    found = identify(problem, ())
    assert found is not None
    pairs = zip(found.layer.terms, found.layer.weights, strict=True)
    per_load = {t.joint: abs(float(w)) for t, w in pairs if t.kind == "load"}
    assert max(per_load.values(), default=0.0) <= 1.0
    left = unseen_errors(problem, along(corrected(problem, found)))
    assert left[2] < unseen_errors(problem, lambda p: p.load)[2]


@pytest.mark.parametrize("apart", [1, 2])
def test_friction_of_a_motor_that_also_turns_with_another_joint_is_predicted(apart: int) -> None:
    """As in wrists driven through hollow shafts: the last motor turns with both joints before it."""
    arm = random_arm(4, seed=5, kinds=("revolute",))
    size = usual_load(arm)

    def turned(q, v, a, load):
        drag = 0.5 * size[3] * np.tanh((v[:, 3] - v[:, 3 - apart]) / 0.01)
        out = np.zeros_like(q)
        out[:, 3], out[:, 3 - apart] = drag, -drag
        return out

    problem = posed(arm, Plant(arm, [turned]), 40.0)
    model = corrected(problem, identify(problem, ()))
    before, after = unseen_errors(problem, lambda p: p.load), unseen_errors(problem, along(model))
    assert np.all(after[[3, 3 - apart]] < MUCH_LESS * before[[3, 3 - apart]])
