"""Links of the model that are wrong, and recordings with other loads: both are told, neither hides the other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.diagnosis.test_free_bodies import friction

from lagnet.diagnosis.diagnose import Diagnosis, diagnose
from lagnet.diagnosis.identified.fit import identify
from lagnet.diagnosis.problem.problem import pose_problem
from lagnet.diagnosis.reference_recording import beyond_one_recording
from lagnet.recordings.conditioning.condition import condition
from lagnet.rigid_body.random_arm import random_arm

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("reference_recording")]

JOINTS = 4
SECONDS = 24.0
MASSES = {0: 0.5, 1: 1.7}  # [kg]
CENTRE = np.array([0.05, -0.04, 0.1])  # [m], in the frame of the last link
NEAR = 0.03  # relative error of a mass
APART = 0.01  # [m] by which a centre may be off
QUIET = 1e-3 * np.ones(JOINTS)  # [N m]
HUM = 20.0  # [N m]


@pytest.fixture(scope="module")
def model():
    return random_arm(JOINTS, seed=3, kinds=("revolute",), fixed=False)


@pytest.fixture(scope="module")
def record(plant, model):
    """Recordings of an arm whose links all have other parameters than its model says, with a load or without."""
    factors = np.random.default_rng(3).uniform(0.5, 2.0, (JOINTS, 1))
    arm = model.with_inertial_parameters(model.inertial_parameters() * factors)

    def recording(seed: int, mass: float = 0.0):
        loaded = arm.with_payload(mass, CENTRE, 0.003 * mass * np.eye(3)) if mass else arm
        return plant(friction, robot=loaded).record(seed, SECONDS)

    return recording


def loads(found: Diagnosis) -> dict[int, float]:
    """Mass by number of the recording, from one."""
    own = [e for e in found.effects if e.effect == "payload"]
    return {int((e.recording or "recording 0").rsplit(" ", 1)[1]): e.value("m") for e in own}


@pytest.fixture(scope="module")
def free_and_loaded(record, model) -> Diagnosis:
    return diagnose([record(1), record(2, MASSES[1])], model, [record(3), record(4, MASSES[1])])


def test_the_load_is_told_in_its_recording_alone(free_and_loaded) -> None:
    assert loads(free_and_loaded) == {2: pytest.approx(MASSES[1], rel=NEAR)}
    load = next(e for e in free_and_loaded.effects if e.effect == "payload")
    np.testing.assert_allclose([load.value(c) for c in ("cx", "cy", "cz")], CENTRE, atol=APART)


def test_friction_keeps_its_name_beside_links_and_loads(free_and_loaded) -> None:
    joints = free_and_loaded.verdict.fit[1].joint, free_and_loaded.verdict.fit[-1].joint
    named = {(e.effect, e.joint): e for e in free_and_loaded.effects if e.effect != "payload"}
    assert set(named) == {("coulomb_friction", joints[0]), ("viscous_friction", joints[1])}
    assert named["coulomb_friction", joints[0]].value("Fc") == pytest.approx(2.0, rel=NEAR)


def test_links_are_identified_and_held_out_recordings_have_the_load_of_their_own(free_and_loaded) -> None:
    assert free_and_loaded.ends_of == (None, 1)
    for fit in free_and_loaded.verdict.fit:
        assert fit.nmse_identified < 0.01 * min(1.0, fit.nmse_nominal)


def test_it_is_said_beyond_what_a_load_is(free_and_loaded) -> None:
    line = next(w for w in free_and_loaded.verdict.warnings if "differ from each other" in w)
    assert "beyond what it carries in recording 1, which its links hold" in line


def test_of_two_loads_the_difference_is_told(record, model) -> None:
    found = diagnose([record(1, MASSES[0]), record(2, MASSES[1])], model)
    assert loads(found) == {2: pytest.approx(MASSES[1] - MASSES[0], rel=NEAR)}


def posed(model, fitted, *held_out):
    fit = condition(fitted)
    return pose_problem(model, fit, condition(held_out, fit.bandwidth))


@pytest.mark.parametrize("mass", [0.0, MASSES[1]])
@pytest.mark.parametrize("knows_shared_links", [True, False])
def test_links_that_all_recordings_share_are_no_load(record, model, mass, knows_shared_links) -> None:
    problem = posed(model, [record(1, mass), record(2, mass)], record(3, mass))
    assert beyond_one_recording(problem, QUIET, identify(problem, ()) if knows_shared_links else None) is None


def test_a_load_shows_beside_links_that_all_recordings_share(record, model) -> None:
    problem = posed(model, [record(1), record(2, MASSES[1])], record(3), record(4, MASSES[1]))
    found = beyond_one_recording(problem, QUIET, identify(problem, ()))
    assert found is not None
    assert [load.recording for load in found.loads] == [1]


def test_a_joint_that_something_else_moves_hides_no_load(record, model) -> None:
    """At joint 0 a sinusoid of time leaves far more than all loads."""

    def disturbed(recording):
        return replace(recording, tau=recording.tau + HUM * np.sin(7.0 * recording.time)[:, None] * np.eye(JOINTS)[0])

    recordings = [disturbed(record(seed, mass)) for seed, mass in enumerate((0.0, MASSES[1], 0.0, MASSES[1]), 1)]
    problem = posed(model, recordings[:2], *recordings[2:])
    found = beyond_one_recording(problem, QUIET, identify(problem, ()))
    assert found is not None
    assert [load.values["m"] for load in found.loads] == pytest.approx([MASSES[1]], rel=NEAR)


def test_one_recording_alone_has_no_other_to_differ_from(record, model) -> None:
    assert beyond_one_recording(posed(model, [record(1)], record(3)), QUIET, None) is None
