"""Rotors of the identified layer: none below zero where the links can have the difference."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.conftest import Plant
from tests.diagnosis.identified.test_identify import along, corrected, posed, unseen_errors, wrong_bodies

from lagnet.diagnosis.identified.fit import identify
from lagnet.rigid_body.random_arm import random_arm


def rotors(found) -> dict[int, float]:
    pairs = zip(found.layer.terms, found.layer.weights, strict=True)
    return {t.joint: float(w) for t, w in pairs if t.kind == "rotor"}


@pytest.mark.parametrize("seed", [2, 7, 9, 14])
def test_a_first_link_that_differs_leaves_no_rotor_of_less_than_nothing(seed: int) -> None:
    """The model's first link is drawn rounder: without the condition its rotor would be −30 % to −90 % of it."""
    arm = random_arm(4, seed=seed, kinds=("revolute",))
    problem = posed(arm, Plant(wrong_bodies(arm, (1.2, 1.0, 1.0, 1.0))))
    found = identify(problem, ())
    assert all(weight >= 0.0 for weight in rotors(found).values())
    before, after = unseen_errors(problem, lambda p: p.load), unseen_errors(problem, along(corrected(problem, found)))
    assert after[0] < 0.6 * before[0]  # some are near the noise already


def test_a_rotor_that_is_there_keeps_its_inertia() -> None:
    arm = random_arm(3, seed=7, kinds=("revolute",))
    inertia = 0.5 * float(arm.mass_matrix(np.zeros((1, 3)))[0, 1, 1])
    problem = posed(arm, Plant(arm, [lambda q, v, a, body: inertia * a * (np.arange(3) == 1)]))
    found = identify(problem, ())
    axis = found.layer.joint_inertia(3)[1, 1] + float(
        problem.nominal.with_inertial_parameters(arm.inertial_parameters() + found.layer.bodies).mass_matrix(
            np.zeros((1, 3))
        )[0, 1, 1]
        - arm.mass_matrix(np.zeros((1, 3)))[0, 1, 1]
    )
    assert axis == pytest.approx(inertia, rel=0.1)
