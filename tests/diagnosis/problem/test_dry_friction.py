"""The speed over which dry friction changes sign is taken from the recordings."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.problem.dry_friction import fit_sign_model


def test_soft_friction_widens_the_sign_of_its_joint_alone(plant, arm, at) -> None:
    soft = 0.1
    real = plant(at(1, lambda q, v, a, t: 4.0 * np.tanh(v / soft)))
    problem = pose(arm, real.record(51), real.record(52)).problem
    sharpened = fit_sign_model(problem)
    assert sharpened.slow[1] == pytest.approx(soft, rel=0.1)
    assert sharpened.slow[1] > 2.0 * problem.slow[1]
    assert sharpened.straight is None
    np.testing.assert_array_equal(sharpened.slow[[0, 2]], problem.slow[[0, 2]])


def test_friction_of_a_regularised_contact_rises_in_a_line(plant, arm, at) -> None:
    """As a simulator with soft dry contact has it: tanh would miss its level, and leave what no law explains."""
    wide, level = 0.12, 4.0
    real = plant(at(1, lambda q, v, a, t: level * np.clip(v / wide, -1.0, 1.0)))
    problem = fit_sign_model(pose(arm, real.record(51), real.record(52)).problem)
    assert problem.straight is not None
    assert list(problem.straight) == [False, True, False]
    assert problem.slow[1] == pytest.approx(wide, rel=0.05)
    result = diagnose([real.record(51), real.record(52)], arm, [real.record(53)])
    assert [(e.effect, e.joint) for e in result.effects] == [("coulomb_friction", arm.joints[1])]
    assert result.effects[0].parameters[0].value == pytest.approx(level, rel=0.01)
    assert not any(left.above_noise for left in result.verdict.unexplained)


@pytest.mark.parametrize("seed", [51, 53, 55, 57])
def test_the_form_of_friction_is_not_read_off_single_samples(plant, arm, at, seed: int) -> None:
    """Reversals between two samples: the few that fall into one are of encoder noise, and no straight line."""
    real = plant(at(1, lambda q, v, a, t: 40.0 * np.clip(v / 1e-4, -1.0, 1.0)))
    problem = fit_sign_model(pose(arm, real.record(seed), real.record(seed + 1)).problem)
    assert problem.straight is None


@pytest.mark.parametrize(
    "law",
    [lambda q, v, a, t: 4.0 * v, lambda q, v, a, t: 3.0 * a, lambda q, v, a, t: 3.0 * v * np.abs(v)],
    ids=["viscous", "rotor", "drag"],
)
def test_what_is_no_dry_friction_changes_nothing(plant, arm, at, law) -> None:
    real = plant(at(1, law))
    problem = pose(arm, real.record(53), real.record(54)).problem
    np.testing.assert_array_equal(fit_sign_model(problem).slow, problem.slow)
