"""The identified layer on disk: read back as it was, loaded layer by layer, refused when damaged."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

import lagnet
from lagnet.errors import ModelError
from lagnet.models.corrected.folder import FILE, save_corrected
from lagnet.models.corrected.identified import IdentifiedLayer
from lagnet.models.corrected.model import CorrectedModel, NamedEffect
from lagnet.models.corrected.motion_terms import KINDS, OVER_POSITION, MotionTerm, Rest
from lagnet.rigid_body.random_arm import random_arm

N = 3
ROUNDING = 1e-9


@pytest.fixture
def model():
    arm = random_arm(N, seed=5, kinds=("revolute",))
    pairs = {kind for kind in KINDS if kind.startswith("cross")}
    terms = tuple(MotionTerm(k, 1, 0.3, 2 if k in pairs else None, 0.2 if k in OVER_POSITION else 0.0) for k in KINDS)
    weights = np.linspace(0.1, 0.4, len(terms))
    rest = Rest(np.full(N, 0.01), np.array([1.0, 0.5, 0.0]))
    layer = IdentifiedLayer(0.05 * arm.inertial_parameters(), terms, weights, rest)
    effects = (NamedEffect("viscous_friction", 0, {"Fv": 1.0}), NamedEffect("rotor_inertia", 1, {"Ia": 2.0}))
    return CorrectedModel(arm, effects, np.full(N, 0.02), identified=layer)


def motion():
    time = np.linspace(0.0, 2.0, 200)
    q = np.column_stack([np.sin(time * k) for k in (2.0, 3.0, 4.0)])
    v = np.column_stack([k * np.cos(time * k) for k in (2.0, 3.0, 4.0)])
    return time, q, v, -q * np.array([4.0, 9.0, 16.0])


def test_all_layers_come_back_and_each_can_be_loaded_apart(model, tmp_path) -> None:
    folder, (time, q, v, a) = save_corrected(model, tmp_path / "corrected"), motion()
    for layers in ("named", "identified", "full"):
        back = lagnet.load_robot(folder, layers=layers)
        expected = model.with_layers(layers)
        got, want = back.torque_along(time, q, v, a), expected.torque_along(time, q, v, a)
        np.testing.assert_allclose(got, want, rtol=ROUNDING, atol=ROUNDING)
        np.testing.assert_allclose(back.mass_matrix(q), expected.mass_matrix(q), rtol=ROUNDING, atol=ROUNDING)
    assert lagnet.load_robot(folder, layers="named").identified is None
    assert lagnet.load_robot(folder).identified is not None


def test_a_layer_in_the_place_of_the_names_holds_their_torque_and_leaves_the_named_layer(model, tmp_path) -> None:
    time, q, v, a = motion()
    transient = NamedEffect("torque_offset", 2, {"b": 3.0}, interval=(0.5, 1.0))
    both = replace(model, effects=(*model.effects, transient), instead=replace(model.identified, bodies=None))
    back = lagnet.load_robot(save_corrected(both, tmp_path / "corrected"))
    plain = CorrectedModel(model.nominal, (transient,), model.slow, identified=both.instead)
    for way in (both, back):
        got, want = way.torque_along(time, q, v, a), plain.torque_along(time, q, v, a)
        np.testing.assert_allclose(got, want, rtol=ROUNDING, atol=ROUNDING)
        np.testing.assert_allclose(way.mass_matrix(q), plain.mass_matrix(q), rtol=ROUNDING, atol=ROUNDING)
        np.testing.assert_allclose(way.gravity_torque(q), model.nominal.gravity_torque(q), rtol=ROUNDING, atol=ROUNDING)
    named = replace(both, identified=None, instead=None).torque_along(time, q, v, a)
    np.testing.assert_allclose(back.with_layers("named").torque_along(time, q, v, a), named, rtol=ROUNDING)
    assert back.effects == both.effects


def test_what_a_layer_has_no_function_of_acts_beside_it_in_memory_and_on_disk(model, tmp_path) -> None:
    time, q, v, a = motion()
    spring = NamedEffect("joint_spring", 1, {"k": 4.0, "q0": 0.1})
    both = replace(
        model, effects=(*model.effects, spring), instead=model.identified, kept=frozenset({("joint_spring", 1)})
    )
    back = lagnet.load_robot(save_corrected(both, tmp_path / "corrected"))
    plain = CorrectedModel(model.nominal, (spring,), model.slow, identified=model.identified)
    assert back.acting == both.acting == (spring,)
    for way in (both, back):
        got, want = way.torque_along(time, q, v, a), plain.torque_along(time, q, v, a)
        np.testing.assert_allclose(got, want, rtol=ROUNDING, atol=ROUNDING)


def test_identified_bodies_enter_the_rigid_terms(model) -> None:
    _, q, v, _ = motion()
    alone = replace(model, identified=None)
    np.testing.assert_allclose(model.gravity_torque(q), 1.05 * alone.gravity_torque(q), rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(model.coriolis_torque(q, v), 1.05 * alone.coriolis_torque(q, v), rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(
        model.inertial_parameters(), 1.05 * model.nominal.inertial_parameters(), rtol=ROUNDING, atol=ROUNDING
    )


@pytest.mark.parametrize(
    "damage",
    [
        {"bodies": [[1.0]]},
        {"terms": [{"kind": "magic", "joint": 0, "scale": 1.0, "other": None, "weight": 1.0}]},
        {"terms": [{"kind": "dry", "joint": 9, "scale": 1.0, "other": None, "weight": 1.0}]},
        {"rest": {"speed": [0.1], "held": [0.0]}},
    ],
)
def test_a_damaged_layer_is_refused(model, tmp_path, damage) -> None:
    folder = save_corrected(model, tmp_path / "corrected")
    text = json.loads((folder / FILE).read_text())
    text["identified"] |= damage
    (folder / FILE).write_text(json.dumps(text))
    with pytest.raises(ModelError, match="is damaged"):
        lagnet.load_robot(folder)


def test_an_unknown_layer_is_refused(model, tmp_path) -> None:
    folder = save_corrected(model, tmp_path / "corrected")
    with pytest.raises(ModelError, match="named"):
        lagnet.load_robot(folder, layers="all")


def test_a_layer_of_an_earlier_format_has_no_centre_of_waves(model, tmp_path) -> None:
    plain = replace(model.identified, terms=model.identified.terms[:4], weights=model.identified.weights[:4])
    folder, (time, q, v, a) = save_corrected(replace(model, identified=plain), tmp_path / "corrected"), motion()
    file = folder / FILE
    text = json.loads(file.read_text())
    text["format"] = 4
    for term in text["identified"]["terms"]:
        del term["centre"]
    file.write_text(json.dumps(text))
    got, want = (m.torque_along(time, q, v, a) for m in (lagnet.load_robot(folder), replace(model, identified=plain)))
    np.testing.assert_allclose(got, want, rtol=ROUNDING, atol=ROUNDING)
