"""Sound arms are left in peace: random chains and robots of the collection."""

from __future__ import annotations

import numpy as np
import pytest
from validation.mutants.bench import recording_of

from lagnet.plausibility.settings import CheckSettings
from lagnet.plausibility.suite import check
from lagnet.rigid_body.random_arm import random_arm
from lagnet.rigid_body.robot import load_description

LIGHT = CheckSettings(samples=48, starts=1, iterations=3)  # the study does the same with full effort
ROBOTS = (
    "ur3",
    "ur5",
    "ur10",
    "panda",
    "kinova",
    "xarm7",
    "z1",
    "asr_twodof",
    "double_pendulum",
    "bravo7_no_ee",
    "so100",
)
IDENTITIES = {  # value, as a share: rounding of the best identities, error of differences for those that differentiate
    "mass_matrix_symmetric": 1e-9,
    "torque_affine_in_acceleration": 1e-9,
    "torque_without_acceleration": 1e-9,
    "coriolis_from_mass_matrix": 1e-7,
    "coriolis_skew_symmetric": 1e-7,
    "gravity_is_gradient": 1e-7,
    "forward_inverts_inverse": 1e-7,
    "energy_along_motion": 1e-9,
}


QUICK_ARMS = 12  # of one to eight joints; all fifty with the slow tests


@pytest.mark.parametrize(
    "seed", [*range(QUICK_ARMS), *(pytest.param(s, marks=pytest.mark.slow) for s in range(QUICK_ARMS, 50))]
)
def test_random_arms_raise_no_alarm(seed: int):
    arm = random_arm(1 + seed % 8, seed)
    report = check(arm, arm, seed=seed, settings=LIGHT)
    assert report.passed, report.headline()


@pytest.mark.parametrize("name", ROBOTS)
def test_robots_of_the_collection_pass(name: str):
    report = check(load_description(name), settings=LIGHT)
    assert report.passed, report.headline()
    for identity, limit in IDENTITIES.items():
        assert report[identity].value < limit


@pytest.mark.parametrize(
    ("name", "meant_for", "link"),
    [
        ("finger_edu", "link_pseudo_inertia", "finger_lower_link"),
        ("talos_arm", "link_inertia_given", "wrist_left_ft_link"),
    ],
)
def test_known_faults_of_the_collection_are_found(name: str, meant_for: str, link: str):
    failures = {c.name: c for c in check(load_description(name), settings=LIGHT).failures}
    assert list(failures) == [meant_for]
    assert failures[meant_for].where["link"] == link


def test_recording_of_the_same_arm_passes():
    arm = random_arm(3, 11, ("revolute",))
    report = check(arm, arm, recordings=[recording_of(arm)], settings=LIGHT)
    assert report.passed, report.headline()
    assert report["recording_within_velocities"].status == "pass"


def test_same_seed_same_report():
    arm = random_arm(2, 5)
    first, second = (check(arm, seed=3, settings=LIGHT).to_json() for _ in range(2))
    assert first == second


def test_upright_arm_does_not_feel_its_base_angle():
    arm = load_description("ur5")
    assert (
        check(arm, settings=CheckSettings(vertical_base=True, samples=48))["base_angle_independence"].status == "pass"
    )
    unasked = check(arm, arm, settings=LIGHT)["base_angle_independence"]
    assert unasked.status == "not_applicable"
    assert "ask with vertical_base" in unasked.detail


def test_values_are_plain_numbers():
    for result in check(random_arm(2, 1), settings=LIGHT).checks:
        assert result.value is None or isinstance(result.value, float)
        assert result.value is None or np.isfinite(result.value)
