"""How much friction a corrected model holds: of names, of the identified layer, and of the models that it corrects."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.identified import IdentifiedLayer
from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.corrected.modelled import COUNTERPARTS, WEIGHTS, modelled_weight
from lagnet.models.corrected.motion_terms import KINDS, MotionTerm, Rest
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.rigid_body.random_arm import random_arm

SLOW = np.full(2, 1e-3)


@pytest.fixture(scope="module")
def arm():
    return random_arm(2, seed=3, kinds=("revolute",))


def layer(**weights: float) -> IdentifiedLayer:
    terms = tuple(MotionTerm(kind, 1) for kind in weights)
    return IdentifiedLayer(None, terms, np.array(list(weights.values())), Rest(SLOW, np.zeros(2)))


def test_a_model_that_was_not_corrected_holds_none(arm) -> None:
    assert modelled_weight(arm, "viscous_friction", 1) == 0.0
    assert modelled_weight(arm, "payload", None) == 0.0


def test_names_and_the_identified_layer_add_up(arm) -> None:
    named = NamedEffect("viscous_friction", 1, {"Fv": 2.0})
    model = CorrectedModel(arm, (named,), SLOW, identified=layer(viscous=0.5, dry=0.3))
    assert modelled_weight(model, "viscous_friction", 1) == pytest.approx(2.5)
    assert modelled_weight(model, "coulomb_friction", 1) == pytest.approx(0.3)
    assert modelled_weight(model, "viscous_friction", 0) == 0.0


def test_a_layer_in_the_place_of_names_counts_alone(arm) -> None:
    named = NamedEffect("viscous_friction", 1, {"Fv": 2.0})
    model = CorrectedModel(arm, (named,), SLOW, identified=layer(viscous=0.5), instead=layer(viscous=2.2))
    assert modelled_weight(model, "viscous_friction", 1) == pytest.approx(2.2)


def test_a_correction_of_a_corrected_model_counts_both_and_never_less_than_nothing(arm) -> None:
    first = CorrectedModel(arm, (NamedEffect("coulomb_friction", 1, {"Fc": 2.0}),), SLOW)
    second = CorrectedModel(first, (NamedEffect("coulomb_friction", 1, {"Fc": -0.5}),), SLOW)
    assert modelled_weight(second, "coulomb_friction", 1) == pytest.approx(1.5)
    third = CorrectedModel(second, (NamedEffect("coulomb_friction", 1, {"Fc": -1.6}),), SLOW)
    assert modelled_weight(third, "coulomb_friction", 1) == 0.0


def test_dry_friction_of_other_laws_and_declared_rotors_count(arm) -> None:
    bristles = NamedEffect("presliding_hysteresis", 1, {"sigma0": 50.0, "Fc": 0.7})
    assert modelled_weight(CorrectedModel(arm, (bristles,), SLOW), "coulomb_friction", 1) == pytest.approx(0.7)
    assert modelled_weight(arm.with_armature(np.array([0.0, 0.2])), "rotor_inertia", 1) == pytest.approx(0.2)


def test_what_acts_for_a_while_is_no_part_of_the_model(arm) -> None:
    passing = NamedEffect("viscous_friction", 1, {"Fv": 2.0}, interval=(0.0, 1.0), recording=0)
    assert modelled_weight(CorrectedModel(arm, (passing,), SLOW), "viscous_friction", 1) == 0.0


def test_every_weight_is_the_first_and_only_bounded_parameter_of_its_law() -> None:
    for effect, held in WEIGHTS.items():
        law = effect_named(effect)
        assert [p.lower for p in law.free_parameters] == [0.0]
        assert all(parameter in {p.name for p in effect_named(name).parameters} for name, parameter in held)
    assert all(kind in KINDS for _, kind in COUNTERPARTS.values())


def test_an_effect_may_be_as_much_below_zero_as_the_model_holds() -> None:
    lower, _ = NamedEffect("coulomb_friction", 1, {"Fc": -0.5}, modelled=2.0).coordinate_bounds()
    assert lower == pytest.approx([-2.0])
    assert NamedEffect("coulomb_friction", 1, {"Fc": 0.5}).coordinate_bounds()[0] == pytest.approx([0.0])
