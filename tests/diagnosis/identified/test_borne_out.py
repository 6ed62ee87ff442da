"""Named friction that links and all other functions of motion leave as it is, and names that they do not bear out."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.conftest import Plant
from tests.diagnosis.identified.test_identify import posed, wrong_bodies

from lagnet.diagnosis.identified.borne_out import is_borne_out, powers_beside
from lagnet.diagnosis.identified.fit import identify
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.modelled import COUNTERPARTS
from lagnet.models.corrected.motion_terms import KINDS
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.rigid_body.random_arm import random_arm

DRY = 1.5  # [N m]


@pytest.fixture(scope="module")
def rubbing():
    """An arm whose second joint has dry friction, and whose last links are not as modelled."""
    arm = random_arm(3, seed=7, kinds=("revolute",))
    law = [lambda q, v, a, body: DRY * np.sign(v) * (np.arange(3) == 1)]
    return posed(wrong_bodies(arm, (1.0, 1.3, 0.7)), Plant(arm, law))


def named(effect: str, joint: int | None = 1, **values: float) -> NamedEffect:
    return NamedEffect(effect, joint, values)


@pytest.mark.parametrize(("value", "expected"), [(DRY, True), (1.3 * DRY, True), (3.0 * DRY, False), (-DRY, False)])
def test_friction_is_borne_out_where_its_weight_beside_free_links_is_alike(rubbing, value, expected) -> None:
    found = identify(rubbing, ())
    assert is_borne_out(found, named("coulomb_friction", Fc=value)) == expected


def test_friction_of_another_joint_and_laws_without_a_function_are_not_borne_out(rubbing) -> None:
    found = identify(rubbing, ())
    assert not is_borne_out(found, named("coulomb_friction", joint=2, Fc=DRY))
    assert not is_borne_out(found, named("joint_spring", k=1.0, q0=0.0))
    assert not is_borne_out(found, named("gravity_tilt", joint=None, x=0.1, y=0.0))


def test_a_straight_line_through_drag_that_grows_with_the_cube_of_speed_is_not_borne_out() -> None:
    arm = random_arm(3, seed=7, kinds=("revolute",))
    problem = posed(arm, Plant(arm, [lambda q, v, a, body: 2.0 * v**3 * (np.arange(3) == 1)]))
    found = identify(problem, ())
    weights = {(t.kind, t.joint): w for t, w in zip(found.layer.terms, found.layer.weights, strict=True)}
    line = weights["viscous", 1]
    assert not is_borne_out(found, named("viscous_friction", Fv=float(line)))


def test_every_counterpart_is_a_parameter_of_its_law() -> None:
    for effect, (parameter, kind) in COUNTERPARTS.items():
        assert parameter in {p.name for p in effect_named(effect).parameters}
        assert kind in KINDS


def test_the_layer_leaves_far_less_than_the_nominal_model(rubbing) -> None:
    before, after = powers_beside(rubbing, rubbing.holdout, (), identify(rubbing, ()).layer)
    assert np.all(after < 0.1 * before)
