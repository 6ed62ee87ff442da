"""A servo-driven model keeps the surface that its arm rests on; a damaged one is refused in one line."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from lagnet.errors import ModelError
from lagnet.models.corrected.servo_driven import ServoDrivenModel
from lagnet.models.corrected.servo_files import load_servo_driven, save_servo_driven
from lagnet.rigid_body.robot import load_description
from lagnet.servos.parameters import law_vector

SURFACE = np.array([5.0, 0.0, 0.0, 0.1, 0.2, 1e4, 0.3])


@pytest.fixture
def folder(tmp_path) -> Path:
    laws = np.tile(law_vector(kp=300.0, kd=20.0, coulomb=2.0, rotor=0.5), (6, 1))
    model = ServoDrivenModel(load_description("ur5"), laws, (True,) * 6, surface=SURFACE)
    return save_servo_driven(model, tmp_path / "corrected")


def test_it_rests_on_it_after_it_was_saved(folder):
    model = load_servo_driven(folder, load_description)
    time, q0 = np.arange(0.0, 1.5, 0.02), np.array([0.0, -1.2, 1.2, 0.0, 0.0, 0.0])
    command = q0 + np.outer(np.minimum(time, 1.0), [0.0, 1.4, 0.0, 0.0, 0.0, 0.0])  # down through the surface
    resting = model.rollout(command, time, q0)
    free = ServoDrivenModel(model.nominal, model.laws, model.scale_is_set).rollout(command, time, q0)
    assert np.array_equal(model.surface, SURFACE)
    assert resting[-1, 1] < free[-1, 1] - 0.02
    assert np.abs(resting[:10] - free[:10]).max() < 1e-9


@pytest.mark.parametrize(
    "damage",
    [
        {"body": 9},
        {"body": 1.5},
        {"hardness": 0.0},
        {"height": "high"},
        {"px": 1e999},
        {"height": None},
        {"friction": -0.1},
    ],
)
def test_a_surface_that_cannot_be_is_refused(folder, damage):
    path = folder / "servo.json"
    text = json.loads(path.read_text(encoding="utf-8"))
    path.write_text(json.dumps(text | {"surface": text["surface"] | damage}), encoding="utf-8")
    with pytest.raises(ModelError, match="damaged"):
        load_servo_driven(folder, load_description)
