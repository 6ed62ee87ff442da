"""Bodies that share what recordings leave open: a payload beside a link, and a first link of a slanted axis."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.conftest import Plant

from lagnet.diagnosis.diagnose import Diagnosis, diagnose
from lagnet.rigid_body.inertia import parameters_of_body
from lagnet.rigid_body.random_arm import random_arm

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("bodies")]

LOAD = parameters_of_body(1.4, np.array([-0.04, -0.02, 0.05]), 2e-3 * np.eye(3))
ARMS = (3, 12, 21)


def told(arm, bodies: np.ndarray) -> Diagnosis:
    real = Plant(arm.with_inertial_parameters(bodies))
    return diagnose([real.record(1, 30.0), real.record(2, 30.0)], arm, [real.record(3, 30.0)])


def names(found: Diagnosis) -> set[tuple[str, str | None]]:
    return {(e.effect, e.joint) for e in found.effects}


def at_noise(found: Diagnosis) -> bool:
    return all(f.nmse_named <= 2.0 * f.nmse_noise_floor + 1e-4 for f in found.verdict.fit)


@pytest.mark.parametrize("seed", ARMS)
def test_a_payload_beside_a_lighter_link_is_found_with_it(seed: int) -> None:
    arm = random_arm(5, seed=seed, kinds=("revolute",))
    bodies = arm.inertial_parameters()
    bodies[3] *= 0.8
    bodies[4] += LOAD
    found = told(arm, bodies)
    assert names(found) <= {("payload", None), ("link_inertia", arm.joints[3]), ("link_inertia", arm.joints[4])}
    assert ("link_inertia", arm.joints[3]) in names(found)
    assert len(found.effects) == 2
    assert at_noise(found)


@pytest.mark.parametrize("seed", ARMS)
def test_a_first_link_of_which_one_moment_shows_is_found(seed: int) -> None:
    arm = random_arm(4, seed=seed, kinds=("revolute",))
    bodies = arm.inertial_parameters()
    bodies[0] *= 1.3
    found = told(arm, bodies)
    assert [e.effect for e in found.effects] == ["link_inertia"]
    assert at_noise(found)


@pytest.mark.parametrize("seed", ARMS)
def test_a_mass_on_the_axis_between_two_links_is_told_of_both(seed: int) -> None:
    """A ball at the origin of a joint's frame turns with neither: it is of the link before the joint or behind it."""
    arm = random_arm(5, seed=seed, kinds=("revolute",))
    bodies = arm.inertial_parameters()
    bodies[3] += parameters_of_body(1.5, np.zeros(3), 1e-6 * np.eye(3))
    effect = told(arm, bodies).verdict.effects[0]
    joints = {2: arm.joints[2], 3: arm.joints[3]}
    assert effect.effect == "link_inertia"
    assert effect.joint in joints.values()
    other = joints[3] if effect.joint == joints[2] else joints[2]
    assert other in effect.also_at
    assert f"{other}, changed in its place" in effect.explanation or f"{other} or " in effect.explanation


def test_a_link_that_shows_by_itself_is_told_alone() -> None:
    arm = random_arm(5, seed=ARMS[0], kinds=("revolute",))
    bodies = arm.inertial_parameters()
    bodies[2] *= 1.4
    found = told(arm, bodies)
    assert names(found) == {("link_inertia", arm.joints[2])}
    assert found.verdict.effects[0].also_at == ()
    assert "changed in its place" not in found.verdict.effects[0].explanation
