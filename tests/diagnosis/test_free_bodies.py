"""Where most links are wrong, what else is missing is judged beside the parameters of all links."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tests.diagnosis.stop_and_go import COULOMB, stop_and_go

from lagnet.diagnosis.diagnose import Diagnosis, diagnose
from lagnet.diagnosis.estimation.friction_at_rest import friction_at_rest
from lagnet.diagnosis.free_bodies import against_given, are_scaled_widely, take_the_place_of_gains
from lagnet.diagnosis.unexplained.remainder import remainder_of
from lagnet.diagnosis.verdict.wording import BESIDE_FREE_LINKS
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.rigid_body.random_arm import random_arm

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("free_bodies")]

JOINTS = 5
SHARP = 1e-3  # [rad/s]
SIZES = {"coulomb_friction": ("Fc", 2.0), "viscous_friction": ("Fv", 0.5)}
NOISE = 3e-5  # of the torque's variance, beyond its noise
NO_GAIN = 0.01  # of the nominal error


def friction(q: np.ndarray, v: np.ndarray, a: np.ndarray, tau: np.ndarray) -> np.ndarray:
    """Coulomb friction at the second joint, viscous friction at the last."""
    out = np.zeros_like(v)
    out[:, 1] = 2.0 * np.tanh(v[:, 1] / SHARP)
    out[:, -1] = 0.5 * v[:, -1]
    return out


@pytest.fixture(scope="module")
def found(plant) -> Diagnosis:
    """An arm whose links all have other parameters than its model says."""
    arm = random_arm(JOINTS, seed=3, kinds=("revolute",), fixed=False)
    factors = np.random.default_rng(3).uniform(0.5, 2.0, (JOINTS, 1))
    real = plant(friction, robot=arm.with_inertial_parameters(arm.inertial_parameters() * factors))
    return diagnose([real.record(1, 40.0), real.record(2, 40.0)], arm, [real.record(3, 40.0)])


def test_friction_is_named_and_no_gain_stands_for_the_links(found) -> None:
    joints = found.verdict.fit[1].joint, found.verdict.fit[-1].joint
    assert {(e.effect, e.joint) for e in found.effects} == set(zip(SIZES, joints, strict=True))
    for effect in found.effects:
        name, size = SIZES[effect.effect]
        assert effect.value(name) == pytest.approx(size, rel=0.03)


def test_the_links_stand_in_the_identified_layer(found) -> None:
    for fit in found.verdict.fit:
        assert fit.nmse_identified <= fit.nmse_noise_floor + NOISE
    assert found.corrected.identified is not None
    assert np.abs(found.corrected.identified.bodies).max() > 0.1


def test_errors_are_those_of_the_model_that_was_given(found) -> None:
    nominal = found.state.problem.nominal
    assert nominal is found.corrected.nominal
    assert found.state.judged is not None
    assert found.state.judged.nominal is not nominal
    assert against_given(found.state) is found.state


def test_the_verdict_says_beside_what_the_names_were_judged(found) -> None:
    assert BESIDE_FREE_LINKS in found.verdict.warnings
    told = next(e.explanation for e in found.effects if e.effect == "coulomb_friction")
    assert "named physics without the links that differ leaves" in told


def test_links_that_are_all_half_as_heavy_give_no_joint_a_gain(plant) -> None:
    arm = random_arm(3, seed=3, kinds=("revolute",), fixed=False)
    real = plant(friction, robot=arm.with_inertial_parameters(0.5 * arm.inertial_parameters()))
    result = diagnose([real.record(1), real.record(2)], arm, [real.record(3)])
    assert "torque_gain" not in {e.effect for e in result.effects}
    assert result.state.judged is not None
    assert max(f.nmse_identified for f in result.verdict.fit) < NO_GAIN * min(
        f.nmse_nominal for f in result.verdict.fit
    )


def gains(q: np.ndarray, v: np.ndarray, a: np.ndarray, tau: np.ndarray) -> np.ndarray:
    """Two of three sensors that read a tenth and a fifth less."""
    return tau * np.array([-0.1, -0.2, 0.0])


def test_gains_of_most_sensors_stay_where_no_link_differs(plant) -> None:
    arm = random_arm(3, seed=3, kinds=("revolute",), fixed=False)
    real = plant(gains, robot=arm)
    result = diagnose([real.record(1), real.record(2)], arm, [real.record(3)])
    found = {e.joint: e.value("g") for e in result.effects if e.effect == "torque_gain"}
    joints = [fit.joint for fit in result.verdict.fit]
    assert found == {joints[0]: pytest.approx(0.9, abs=0.01), joints[1]: pytest.approx(0.8, abs=0.01)}


@pytest.mark.parametrize(("joints", "asked"), [(2, True), (4, True), (5, False), (1, False)])
def test_gains_at_half_of_the_joints_ask_for_the_links(joints: int, asked: bool) -> None:
    effects = [NamedEffect("torque_gain", j, {"g": 0.8}) for j in range(min(2, joints))]
    candidate: Any = SimpleNamespace(effects=effects, problem=SimpleNamespace(n_dof=joints))
    assert are_scaled_widely(candidate) is asked


def test_free_links_do_not_win_by_what_friction_keeps_at_rest() -> None:
    """The run beside free links knows the share by then; the candidate is asked with the share as well."""
    problem, noise = stop_and_go(joints=3), np.full(3, 1e-3)
    gain = NamedEffect("torque_gain", 1, {"g": 0.8})
    known = replace(problem, held=friction_at_rest(problem, [COULOMB]))
    beside: Any = SimpleNamespace(effects=[COULOMB], after=remainder_of(known, [COULOMB]))
    candidate: Any = SimpleNamespace(effects=[COULOMB, gain], problem=problem, noise=noise)
    assert not take_the_place_of_gains(beside, candidate)
