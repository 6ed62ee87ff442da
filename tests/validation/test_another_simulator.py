"""MuJoCo's plants are the arms that the diagnosis is given, but for what is hidden in them."""

from __future__ import annotations

import json

import numpy as np
import pytest
from validation.another_simulator.hidden import ALONE, SIZES, UNLISTED, Hidden, drawn
from validation.another_simulator.motions import drawn as motion
from validation.another_simulator.mujoco_arm import MujocoArm
from validation.another_simulator.plants import plant
from validation.another_simulator.study import figures, judge

from lagnet.diagnosis.diagnose import diagnose
from lagnet.effects.catalogue import CATALOGUE
from lagnet.rigid_body.random_arm import random_arm, random_arm_urdf

SAME = 1e-6  # of the largest torque: two libraries, one arm
SECONDS = 4.0
SHOWN = 0.005  # of the usual torque: least that something hidden changes


@pytest.fixture(scope="module")
def urdf() -> str:
    return random_arm_urdf(3, seed=5, kinds=("revolute",))


@pytest.fixture(scope="module")
def free(urdf) -> MujocoArm:
    return MujocoArm(urdf)


@pytest.fixture(scope="module")
def reference():
    limits = np.full(3, 1.5)
    return motion("sines", -limits, limits, limits, SECONDS, np.random.default_rng(0))


def test_nothing_hidden_is_rigid_body_dynamics(free) -> None:
    arm = random_arm(3, seed=5, kinds=("revolute",))
    q, v, a = np.random.default_rng(1).uniform(-1.0, 1.0, (3, 20, 3))
    found = np.array([free.torque(*state) for state in zip(q, v, a, strict=True)])
    expected = arm.inverse_dynamics(q, v, a)
    np.testing.assert_allclose(found, expected, atol=SAME * np.abs(expected).max())


def test_every_effect_that_is_drawn_is_in_the_catalogue() -> None:
    assert set(ALONE) <= set(CATALOGUE)
    assert set(SIZES) == {*ALONE, *UNLISTED}


BY_SENSOR = ("saturation", "torque_gain", "torque_offset", "encoder_offset", "time_delay")


@pytest.mark.slow
@pytest.mark.parametrize("effect", [e for e in SIZES if e not in BY_SENSOR])
def test_what_is_hidden_changes_the_torque(effect, urdf, free, reference) -> None:
    usual = free.usual(reference, SECONDS)
    cause = drawn(effect, 1, usual, np.random.default_rng(2))
    told = MujocoArm(urdf, [cause]).run(free, reference, SECONDS, 100.0)
    plain = free_run(free, urdf, reference)
    assert np.abs(told.tau - plain.tau).max() > SHOWN * usual.torque.max()


def free_run(free: MujocoArm, urdf: str, reference):
    return MujocoArm(urdf).run(free, reference, SECONDS, 100.0)


def test_the_same_seed_gives_the_same_plant() -> None:
    first, second = (plant(3, 11, SECONDS) for _ in range(2))
    assert first.hidden == second.hidden
    np.testing.assert_array_equal(first.recordings[0].tau, second.recordings[0].tau)


def test_a_cause_without_torque_is_not_asked_for_and_a_large_one_is() -> None:
    spring, first_link = plant(71, 32, SECONDS), plant(71, 30, SECONDS)  # 30 scales a link that turns about its axis
    assert all(spring.shown)
    assert [(h.effect, h.joint) for h in first_link.hidden] == [("link_inertia", 0)]
    assert first_link.shown == (False,)


def test_figures_count_claims_and_causes() -> None:
    cause, strange = {"effect": "payload"}, {"effect": UNLISTED[0]}
    listed = {"listed": 1, "hidden": [cause], "found": 1, "claims": ["a at x", "b at y"], "wrong": ["b at y"]}
    empty = {"listed": 0, "hidden": [], "found": 0, "claims": [], "wrong": []}
    unseen = {**empty, "hidden": [cause], "not_shown": ["payload"]}
    unlisted = {**empty, "hidden": [strange]}
    found = figures([{"not_shown": [], **c, "processor_seconds": 1.0} for c in (listed, empty, unseen, unlisted)])
    assert (found["causes_not_shown"], found["plants_with_unlisted_physics"]) == (1, 1)
    assert (found["precision"], found["recall"], found["of_these_with_a_claim"]) == (0.5, 1.0, 0)
    assert judge(found) == {"precision": False, "recall": True, "nothing_hidden": True}
    assert json.dumps(found)
    assert Hidden("payload", None).values == {}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "index", "expected"),
    [
        (87, 1, {"coulomb_friction"}),  # which turns 7 ms before the speed does, and is no delay
        (82, 37, {"coulomb_friction", "time_delay"}),  # 0.5 % of the torque
        (84, 15, {"joint_elasticity", "rotor_inertia"}),
        (83, 16, {"viscous_friction", "saturation"}),  # a limit that friction reaches
    ],
)
def test_small_causes_have_their_names_and_no_others(seed: int, index: int, expected: set[str]) -> None:
    case = plant(seed, index, 22.0)
    result = diagnose(case.recordings[:-1], case.robot, case.recordings[-1:], seed=0)
    assert {e.effect for e in result.effects} == expected
