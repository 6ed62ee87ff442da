"""A corrected model on disk: read back as it was, refused when damaged, without anything that could run code."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

import lagnet
from lagnet.errors import LagnetError, ModelError
from lagnet.models.corrected.folder import FILE, load_corrected, save_corrected
from lagnet.models.corrected.identified import IdentifiedLayer
from lagnet.models.corrected.model import LAYERS, CorrectedModel, NamedEffect
from lagnet.models.corrected.motion_terms import Rest
from lagnet.models.corrected.remainder.learned import LearnedRemainder
from lagnet.models.files.loading import load_any
from lagnet.rigid_body.random_arm import random_arm, random_arm_urdf
from lagnet.rigid_body.robot import load_description

EXACT = 1e-9  # numbers written with all their digits

EFFECTS = (
    NamedEffect("viscous_friction", 0, {"Fv": 1.0 / 3.0}),
    NamedEffect("torque_offset", 2, {"b": -0.125}, (0.5, 2.0)),
    NamedEffect(
        "payload",
        None,
        {"m": 0.8, "cx": 0.01, "cy": 0.0, "cz": 0.05}
        | {"Ixx": 0.004, "Ixy": 0.0, "Iyy": 0.004, "Ixz": 0.0, "Iyz": 0.0, "Izz": 0.003},
    ),
)


@pytest.fixture
def model():
    arm, straight = random_arm(3, seed=5, kinds=("revolute",)), np.array([True, False, True])
    left = np.array([[0.1, 0.0, 0.2], [0.1, 0.0, 0.1], [0.0, 0.0, 0.1]])
    errors: dict[str, np.ndarray] = dict(zip(LAYERS, left, strict=True))
    return CorrectedModel(arm, EFFECTS, np.array([0.01, 0.02, 0.03]), straight=straight, errors=errors)


@pytest.fixture
def folder(model, tmp_path):
    return save_corrected(model, tmp_path / "corrected")


def samples(n_dof: int = 3):
    rng = np.random.default_rng(1)
    return [rng.uniform(-1.0, 1.0, (25, n_dof)) for _ in range(3)]


def rewrite(folder, **changes) -> None:
    text = json.loads((folder / FILE).read_text())
    (folder / FILE).write_text(json.dumps(text | changes))


def test_friction_per_load_of_an_older_folder_follows_the_torque_of_the_link(tmp_path) -> None:
    motor = NamedEffect("load_dependent_friction", 0, {"K": 0.1, "side": 1.0})
    model = CorrectedModel(random_arm(2, seed=3), (motor,), np.full(2, 0.01))
    folder = save_corrected(model, tmp_path / "corrected")
    assert load_any(folder).effects == (motor,)
    text = json.loads((folder / FILE).read_text())
    del text["effects"][0]["values"]["side"]
    rewrite(folder, format=7, effects=text["effects"])
    assert load_any(folder).effects == (replace(motor, values={"K": 0.1, "side": 0.0}),)


def test_a_flexible_joint_of_an_older_folder_has_no_damper(tmp_path) -> None:
    effect = NamedEffect("joint_elasticity", 1, {"K": 90.0, "D": 0.0})
    model = CorrectedModel(random_arm(3, seed=5, kinds=("revolute",)), (effect,), np.full(3, 0.01))
    folder = save_corrected(model, tmp_path / "corrected")
    text = json.loads((folder / FILE).read_text())
    del text["effects"][0]["values"]["D"]
    rewrite(folder, format=5, effects=text["effects"])
    assert load_any(folder).effects == (effect,)


def test_a_coupled_motor_of_an_older_folder_keeps_its_ratio(tmp_path) -> None:
    values = {"Fv": 1.0, "Fc": 0.5, "Ia": 0.1, "ratio": -1.0}
    effect = NamedEffect("coupled_transmission", 1, values)
    model = CorrectedModel(random_arm(3, seed=5, kinds=("revolute",)), (effect,), np.full(3, 0.01))
    folder = save_corrected(model, tmp_path / "corrected")
    (folder / FILE).write_text((folder / FILE).read_text().replace('"ratio"', '"sense"'))
    assert load_any(folder).effects == (effect,)


def test_a_model_read_back_is_the_same_model(model, folder) -> None:
    back = load_any(folder)
    assert back.effects == model.effects
    assert back.joints == model.joints
    assert (back.kind, back.source) == ("corrected", str(folder))
    assert len(back.sha256) == 64
    assert back.errors is not None
    for layer in LAYERS:
        np.testing.assert_array_equal(back.errors[layer], model.errors[layer])
    np.testing.assert_array_equal(back.straight, model.straight)
    q, v, a = samples()
    np.testing.assert_allclose(back.inverse_dynamics(q, v, a), model.inverse_dynamics(q, v, a), rtol=EXACT, atol=EXACT)
    np.testing.assert_allclose(back.mass_matrix(q), model.mass_matrix(q), rtol=EXACT, atol=EXACT)


def test_a_model_knows_what_the_layers_that_it_has_leave(model) -> None:
    identified = IdentifiedLayer(np.zeros((3, 10)), (), np.zeros(0), Rest(model.slow, np.zeros(3)))
    learned = replace(model, identified=identified, remainder=LearnedRemainder((), model.slow))
    for layer in LAYERS:
        np.testing.assert_array_equal(learned.with_layers(layer).left, model.errors[layer])
    assert replace(model, errors=None).left is None


def test_an_older_folder_tells_what_names_leave_and_no_more(model, folder) -> None:
    rewrite(folder, format=6, left=[0.1, 0.0, 0.2])
    back = load_any(folder)
    assert back.errors is not None
    for layer in LAYERS:
        np.testing.assert_array_equal(back.errors[layer], model.errors["named"])


@pytest.mark.parametrize("left", [{"named": [0.1, 0.0, 0.2]}, {layer: None for layer in LAYERS}, [0.1], "0.1"])
def test_errors_that_are_not_of_every_layer_and_joint_are_damage(folder, left) -> None:
    rewrite(folder, left=left)
    with pytest.raises(ModelError, match=r"damaged|joints are not"):
        load_any(folder)


def test_the_folder_of_a_diagnosis_is_found_from_outside(folder) -> None:
    assert load_any(folder.parent).effects == EFFECTS
    assert lagnet.load_robot(folder).effects == EFFECTS


def test_the_robot_written_back_carries_the_payload(model, folder) -> None:
    written = load_description(folder / "robot.urdf")
    q, v, a = samples()
    alone = CorrectedModel(model.nominal, EFFECTS[2:], model.slow)
    np.testing.assert_allclose(written.inverse_dynamics(q, v, a), alone.inverse_dynamics(q, v, a), rtol=1e-7, atol=1e-7)


def test_a_corrected_model_on_a_corrected_model_is_kept_whole(model, tmp_path) -> None:
    loaded = CorrectedModel(model, (NamedEffect("coulomb_friction", 1, {"Fc": 0.7}),), model.slow)
    back = load_any(save_corrected(loaded, tmp_path / "twice"))
    assert back.nominal.effects == EFFECTS
    q, v, a = samples()
    np.testing.assert_allclose(back.inverse_dynamics(q, v, a), loaded.inverse_dynamics(q, v, a), rtol=EXACT, atol=EXACT)


def test_nothing_points_outside_the_folder(folder, tmp_path) -> None:
    moved = tmp_path / "elsewhere"
    folder.rename(moved)
    assert load_any(moved).effects == EFFECTS


def test_nothing_in_it_can_run_code(folder) -> None:
    files = [p for p in folder.rglob("*") if p.is_file()]
    assert {p.suffix for p in files} <= {".json", ".urdf", ".xml"}
    for path in files:
        assert path.read_bytes().isascii() or path.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"format": 99}, "newer"),
        ({"effects": [{"effect": "magic", "joint": 0, "values": {}}]}, "magic"),
        ({"effects": [{"effect": "viscous_friction", "joint": 7, "values": {"Fv": 1.0}}]}, "joint 7"),
        ({"effects": [{"effect": "viscous_friction", "joint": 0, "values": {}}]}, "Fv"),
        ({"effects": [{"effect": "viscous_friction", "joint": 0, "values": {"Fv": "much"}}]}, "damaged"),
        ({"effects": [{"effect": "viscous_friction", "joint": 0, "values": {"Fv": 1e999}}]}, "finite"),
        ({"effects": [{"effect": "payload", "joint": 1, "values": {}}]}, "payload"),
        ({"effects": "all"}, "damaged"),
        ({"slow": [0.1]}, "joints"),
        ({"slow": None}, "damaged"),
        ({"joints": ["x", "y", "z"]}, "joints"),
        ({"nominal": {}}, "damaged"),
        ({"nominal": {"kind": "robot", "file": "../../secret.urdf", "sha256": "0" * 64}}, "missing"),
    ],
)
def test_a_damaged_file_is_refused_in_one_line(folder, changes, message) -> None:
    rewrite(folder, **changes)
    with pytest.raises(ModelError, match=message) as caught:
        load_any(folder)
    assert "\n" not in str(caught.value)
    assert FILE in str(caught.value) or "nominal" in str(caught.value) or "secret" in str(caught.value)


@pytest.mark.parametrize("text", ["", "[1, 2]", "{", "nonsense", "\x00\x01"])
def test_what_is_no_object_is_refused(folder, text) -> None:
    (folder / FILE).write_text(text)
    with pytest.raises(ModelError):
        load_any(folder)


def test_a_nominal_model_that_was_swapped_is_noticed(folder) -> None:
    (folder / "nominal.urdf").write_text(random_arm_urdf(3, seed=6, kinds=("revolute",)))
    with pytest.raises(ModelError, match="changed"):
        load_any(folder)
    (folder / "nominal.urdf").unlink()
    with pytest.raises(ModelError, match="missing"):
        load_any(folder)


def test_a_huge_file_is_refused_before_it_is_read(folder) -> None:
    with (folder / FILE).open("wb") as file:
        file.truncate(10_000_001)
    with pytest.raises(ModelError, match="larger"):
        load_any(folder)


def test_a_folder_without_a_model_says_what_to_give(tmp_path) -> None:
    with pytest.raises(LagnetError, match="neither a trained nor a corrected model"):
        load_any(tmp_path)


def test_a_nominal_model_that_cannot_be_saved_is_named(tmp_path) -> None:
    class Plain:
        joints, n_dof = ("a",), 1

    with pytest.raises(ModelError, match="Plain"):
        save_corrected(CorrectedModel(Plain(), (), np.ones(1)), tmp_path / "out")


def test_reading_asks_the_given_reader_for_the_nominal_model(folder, model) -> None:
    seen = []

    def read(path):
        seen.append(path)
        return model.nominal

    load_corrected(folder, read)
    assert seen == [folder / "nominal.urdf"]
