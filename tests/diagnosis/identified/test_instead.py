"""A layer stands in the place of names only where their values hinder it."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.conftest import Plant

from lagnet.diagnosis.identified import folds
from lagnet.diagnosis.identified.equations import joint_equations
from lagnet.diagnosis.identified.fit import identify
from lagnet.diagnosis.identified.instead import instead_of_names, kept_among
from lagnet.diagnosis.identified.verdict_entry import INSTEAD, identified_as_json
from lagnet.diagnosis.problem.problem import pose_problem
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.recordings.conditioning.condition import condition
from lagnet.rigid_body.random_arm import random_arm

HEAVIER = np.array([1.6, 0.6, 1.5])
FRICTION = 0.8  # N m s/rad


def posed(nominal, plant):
    fit = condition([plant.record(1, 24.0)])
    return pose_problem(nominal, fit, condition([plant.record(2, 24.0)], fit.bandwidth))


def error_on_blocks(found, joint: int) -> float:
    """Squared error of a joint on held-out blocks [N² m²], whatever names explained before."""
    return float(found.choice.nmse[joint] * joint_equations(found.design)[joint].power)


def test_a_gain_in_the_place_of_wrong_links_is_given_up() -> None:
    arm = random_arm(3, seed=21, kinds=("revolute",), fixed=False)
    real = arm.with_inertial_parameters(arm.inertial_parameters() * HEAVIER[:, None])
    problem = posed(arm, Plant(real))
    wrong = [NamedEffect("torque_gain", j, {"g": g}) for j, g in enumerate(HEAVIER)]
    assert instead_of_names(problem, wrong, identify(problem, wrong)) is not None


def test_none_is_sought_where_names_leave_noise_alone(monkeypatch) -> None:
    arm = random_arm(3, seed=21, kinds=("revolute",), fixed=False)
    problem = posed(arm, Plant(arm.with_inertial_parameters(arm.inertial_parameters() * HEAVIER[:, None])))
    wrong = [NamedEffect("torque_gain", j, {"g": g}) for j, g in enumerate(HEAVIER)]
    beside = identify(problem, wrong)
    assert instead_of_names(problem, wrong, beside, floor=np.zeros(3)) is not None
    monkeypatch.setattr("lagnet.diagnosis.identified.instead.identify", lambda *_: pytest.fail("sought"))
    assert instead_of_names(problem, wrong, beside, floor=problem.scale) is None


def test_right_names_stay_with_and_without_more_to_identify() -> None:
    arm = random_arm(3, seed=21, kinds=("revolute",), fixed=False)
    law = lambda q, v, a, load: FRICTION * v  # noqa: E731
    right = [NamedEffect("viscous_friction", j, {"Fv": FRICTION}) for j in range(3)]
    for factors in (1.0, HEAVIER[:, None]):
        real = arm.with_inertial_parameters(arm.inertial_parameters() * factors)
        problem = posed(arm, Plant(real, [law]))
        assert instead_of_names(problem, right, identify(problem, right)) is None


def test_parameters_fitted_to_few_independent_samples_have_seen_the_blocks_that_judge_them() -> None:
    arm = random_arm(3, seed=21, kinds=("revolute",), fixed=False)
    problem = posed(arm, Plant(arm, [lambda q, v, a, load: FRICTION * v]))
    right = [NamedEffect("viscous_friction", j, {"Fv": FRICTION}) for j in range(3)]
    assert instead_of_names(problem, right, None, samples=np.full(3, 400.0)) is None
    assert instead_of_names(problem, right, None, samples=np.full(3, 10.0)) is not None


def test_transients_are_kept_and_nothing_stands_in_its_place() -> None:
    arm = random_arm(2, seed=4, kinds=("revolute",), fixed=False)
    problem = posed(arm, Plant(arm))
    there = [NamedEffect("torque_offset", 0, {"b": 5.0}, interval=(1.0, 2.0))]
    assert instead_of_names(problem, there, None) is None


def test_a_spring_acts_on_beside_a_layer_in_the_place_of_gains(monkeypatch) -> None:
    arm = random_arm(3, seed=21, kinds=("revolute",), fixed=False)
    real = arm.with_inertial_parameters(arm.inertial_parameters() * HEAVIER[:, None])
    spring = NamedEffect("joint_spring", 1, {"k": 6.0, "q0": 0.2})
    problem = posed(arm, Plant(real, [lambda q, v, a, load: 6.0 * (q - 0.2) * (np.arange(3) == 1)]))
    names = [*(NamedEffect("torque_gain", j, {"g": g}) for j, g in enumerate(HEAVIER)), spring]
    assert kept_among(names) == (spring,)
    instead = instead_of_names(problem, names, identify(problem, names))
    assert instead is not None
    assert instead.kept == (spring,)
    assert error_on_blocks(instead.found, 1) < error_on_blocks(identify(problem, ()), 1)
    monkeypatch.setattr(folds, "MUCH", np.inf)  # no functions over position, which come near to a spring
    assert error_on_blocks(instead.found, 1) < 0.1 * error_on_blocks(identify(problem, ()), 1)


def test_a_spring_in_the_place_of_a_wrong_link_is_given_up() -> None:
    arm = random_arm(3, seed=21, kinds=("revolute",), fixed=False)
    problem = posed(arm, Plant(arm.with_inertial_parameters(arm.inertial_parameters() * HEAVIER[:, None])))
    wrong = [NamedEffect("joint_spring", 1, {"k": -8.0, "q0": 0.9})]
    beside = identify(problem, wrong)
    instead = instead_of_names(problem, wrong, beside)
    assert instead is not None
    assert instead_of_names(problem, wrong, beside, floor=problem.scale) is not None, "whatever it leaves here"
    assert instead.kept == ()
    assert np.all(instead.found.choice.nmse <= 1.01 * identify(problem, ()).choice.nmse)


def test_a_layer_in_the_place_of_the_names_says_so() -> None:
    arm = random_arm(3, seed=21, kinds=("revolute",), fixed=False)
    real = arm.with_inertial_parameters(arm.inertial_parameters() * HEAVIER[:, None])
    found = identify(posed(arm, Plant(real, [lambda q, v, a, load: FRICTION * v])), ())
    beside, instead = (identified_as_json(found, arm, arm.joints, told)["words"] for told in (False, True))
    assert instead.startswith(INSTEAD)
    assert "beside the named physics at" in beside
    assert "beside the named physics" not in instead
