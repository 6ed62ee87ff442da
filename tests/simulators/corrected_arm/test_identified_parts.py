"""The identified layer in an exported arm: the same torque where a simulator has a law for it, else told."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lagnet.models.corrected.identified import IdentifiedLayer
from lagnet.models.corrected.model import CorrectedModel, NamedEffect
from lagnet.models.corrected.motion_terms import MotionTerm, Rest
from lagnet.rigid_body.random_arm import random_arm
from lagnet.simulators.corrected_arm.arm_physics import arm_physics
from lagnet.simulators.export import export_model
from lagnet.simulators.exported import write_export_json
from lagnet.simulators.registry import exporter_named
from lagnet.simulators.replay import ReplaySettings, started

ARM = random_arm(2, seed=3, kinds=("revolute",), fixed=False)
REST = Rest(np.full(2, 1e-3), np.zeros(2))


def layer(bodies: np.ndarray | None, **weights: float) -> IdentifiedLayer:
    terms = tuple(MotionTerm(kind, 1, 2.0 if kind == "drag" else 1.0) for kind in weights)
    return IdentifiedLayer(bodies, terms, np.array(list(weights.values())), REST)


def corrected(identified: IdentifiedLayer, *effects: NamedEffect) -> CorrectedModel:
    return CorrectedModel(ARM, effects, np.full(2, 1e-3), identified=identified)


HEAVIER = 0.1 * ARM.inertial_parameters() * np.array([[0.0], [1.0]])


SPRING = (
    NamedEffect("torque_gain", 1, {"g": 1.3}),
    NamedEffect("torque_offset", 1, {"b": 0.2}),
    NamedEffect("viscous_friction", 1, {"Fv": 0.5}),
    NamedEffect("joint_spring", 1, {"k": 0.9, "q0": 0.3}),
    NamedEffect("torque_ripple", 1, {"N": 4.0, "amplitude": 0.3, "phase": 0.5}),
)


@pytest.mark.parametrize(
    "model",
    [
        corrected(layer(HEAVIER, viscous=0.7, rotor=0.05, offset=0.4, spring=1.2)),
        corrected(layer(HEAVIER, viscous=0.7, rotor=0.05, offset=0.4, spring=1.2, gain=0.3)),
        corrected(layer(None, viscous=0.7, gain=0.3), *SPRING),
    ],
    ids=["weights", "a gain among them", "a gain beside named physics"],
)
def test_the_engine_accelerates_as_the_corrected_model_does(model: CorrectedModel) -> None:
    rng = np.random.default_rng(0)
    with started(model, ReplaySettings()) as (_, engine):
        for _ in range(5):
            q, v, tau = rng.uniform(-0.5, 0.5, (3, 2))
            engine.put(q, v)
            engine.advance(5.0 * tau, 1e-3)
            wanted = model.forward_dynamics(q[None], v[None], 5.0 * tau[None])[0]
            np.testing.assert_allclose(
                (engine.read()[1] - v) / 1e-3, wanted, rtol=0.02, atol=0.02 * np.max(abs(wanted))
            )


def test_every_part_is_told_with_its_element_or_the_reason(tmp_path: Path) -> None:
    model = corrected(layer(HEAVIER, viscous=0.7, drag=0.2, dry=-0.3))
    exporter = exporter_named("mjcf")
    write_export_json(export_model(model, exporter, tmp_path), tmp_path)
    told = json.loads((tmp_path / "export.json").read_text(encoding="utf-8"))["identified"]
    status = {entry["identified"]: entry["status"] for entry in told}
    assert status == {
        "bodies": "exact",
        "viscous": "exact",
        "drag": "not_representable",
        "dry": "not_representable",
    }
    assert all(entry["element"] or entry["reason"] for entry in told)


@pytest.mark.parametrize(("named", "left"), [(0.0, 0.0), (0.5, 0.2)])
def test_less_friction_than_named_is_taken_off_but_never_below_zero(named: float, left: float) -> None:
    effects = (NamedEffect("coulomb_friction", 1, {"Fc": named}),) if named else ()
    arm = arm_physics(corrected(layer(None, dry=-0.3), *effects))
    assert arm.forward[1] == pytest.approx(left)
    assert [part.alike is None for part in arm.identified] == [not named]


def test_bodies_that_are_none_are_left_out_and_told() -> None:
    arm = arm_physics(corrected(layer(-20.0 * HEAVIER)))
    np.testing.assert_allclose(arm.robot.inertial_parameters(), ARM.inertial_parameters(), rtol=1e-9)
    assert "no bodies of matter" in arm.identified[0].reason


def test_weights_are_of_the_log_whose_gain_is_named() -> None:
    gain = NamedEffect("torque_gain", 1, {"g": 2.0})
    arm = arm_physics(corrected(layer(None, viscous=0.8, offset=0.4), gain))
    assert arm.viscous[1] == pytest.approx(0.4)
    assert arm.drives[1].offset == pytest.approx(0.4)


def test_without_an_identified_layer_nothing_is_told() -> None:
    assert arm_physics(replace(corrected(layer(None)), identified=None)).identified == ()
