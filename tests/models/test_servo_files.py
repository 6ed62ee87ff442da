"""A servo-driven model keeps what was found and what it corrects; a damaged folder is refused in one line."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from lagnet.errors import ModelError
from lagnet.models.corrected.servo_driven import FoundCause, ServoDrivenModel
from lagnet.models.corrected.servo_files import load_servo_driven, save_servo_driven
from lagnet.models.files.loading import load_any
from lagnet.rigid_body.random_arm import random_arm
from lagnet.servos.parameters import law_vector

ARM = random_arm(2, seed=3, kinds=("revolute",), fixed=False)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    laws = np.tile(law_vector(kp=30.0, kd=3.0, rotor=0.05), (2, 1))
    heavier = ARM.with_inertial_parameters(ARM.inertial_parameters() * 1.1)
    before = ServoDrivenModel(ARM, laws, (True, False), voltage=12.0)
    causes = (
        FoundCause("coulomb_friction", 1, "named", {"Fc": 0.2}),
        FoundCause("payload", None, "tied", {"m": 0.1}),
    )
    changed = laws.copy()
    changed[1] = law_vector(kp=30.0, kd=3.0, rotor=0.05, coulomb=0.2)
    model = ServoDrivenModel(heavier, changed, (True, False), voltage=12.0, causes=causes, before=before)
    return save_servo_driven(model, tmp_path / "corrected")


def test_it_comes_back_with_its_causes_and_what_it_corrects(folder: Path) -> None:
    model = load_any(folder)
    assert [(c.effect, c.joint, c.status, dict(c.values)) for c in model.causes] == [
        ("coulomb_friction", 1, "named", {"Fc": 0.2}),
        ("payload", None, "tied", {"m": 0.1}),
    ]
    assert model.before is not None
    assert (model.voltage, model.before.voltage) == (12.0, 12.0)
    np.testing.assert_array_equal(model.before.laws[0], model.laws[0])
    ratio = model.nominal.inertial_parameters() / model.before.nominal.inertial_parameters()
    np.testing.assert_allclose(ratio[np.isfinite(ratio)], 1.1, rtol=1e-6)


def test_a_folder_of_before_loads_without_them(folder: Path) -> None:
    path = folder / "servo.json"
    text = json.loads(path.read_text(encoding="utf-8"))
    old = {k: v for k, v in text.items() if k not in ("nominal", "found")}
    path.write_text(json.dumps(old), encoding="utf-8")
    model = load_any(folder)
    assert (model.causes, model.before) == ((), None)
    effects = [{"effect": "payload", "joint": None, "status": "named"}]
    path.write_text(json.dumps(old | {"found": {"effects": effects}}), encoding="utf-8")
    assert load_any(folder).causes == (FoundCause("payload", None, "named", {}),)


@pytest.mark.parametrize(
    "damage",
    [
        {"found": {"effects": [{"effect": "payload", "joint": "none such", "status": "named"}]}},
        {"found": {"effects": [{"effect": "payload", "joint": None, "status": "named", "values": {"m": 1e999}}]}},
        {"found": {"effects": [3]}},
        {"found": 3},
        {"nominal": {"robot": "nominal.urdf"}},
        {"laws": [{"kp": -1.0}, {}]},
    ],
)
def test_a_damaged_one_is_refused(folder: Path, damage: dict) -> None:
    path = folder / "servo.json"
    path.write_text(json.dumps(json.loads(path.read_text(encoding="utf-8")) | damage), encoding="utf-8")
    with pytest.raises(ModelError, match="damaged"):
        load_any(folder)


def test_a_description_outside_of_the_folder_is_not_read(folder: Path) -> None:
    path = folder / "servo.json"
    text = json.loads(path.read_text(encoding="utf-8"))
    read: list[Path] = []

    def reader(file: Path):
        read.append(file)
        return load_any(file)

    path.write_text(json.dumps(text | {"robot": "../../corrected/" + text["robot"]}), encoding="utf-8")
    load_servo_driven(folder, reader)
    assert all(file.parent == folder for file in read)
