"""What every exporter of servo-driven arms owes: a place or a reason for every cause, files, and measured claims."""

from __future__ import annotations

import json
import runpy
from pathlib import Path

import mujoco
import numpy as np
import pytest

from lagnet.errors import ModelError
from lagnet.models.corrected.servo_driven import FoundCause, ServoDrivenModel
from lagnet.rigid_body.random_arm import random_arm
from lagnet.servos.parameters import LAW, NO_LIMIT, law_vector
from lagnet.simulators.corrected_arm.servo_arm import at_nominal_load, servo_arm
from lagnet.simulators.export import export_model
from lagnet.simulators.exported import write_export_json
from lagnet.simulators.registry import EXPORTERS
from lagnet.simulators.round_trips.servo_cases import SERVO_CASES
from lagnet.simulators.servo_exporters.registry import SERVO_EXPORTERS
from lagnet.simulators.servo_exporters.servo_exporter import CAUSE_OF, CAUSES

ARM = random_arm(3, seed=5, kinds=("revolute",), fixed=False)
SURFACE = np.array([2.0, 0.01, 0.02, -0.2, -0.4, 3e4, 0.2])
EXACT = 0.01  # of what a cause moves, the pass line of validation/round_trip


def driven(**changed: float) -> ServoDrivenModel:
    plain = {"kp": 20.0, "kd": 1.5, "rotor": 0.1}
    laws = np.tile(law_vector(**plain), (3, 1))
    laws[1] = law_vector(**{**plain, **changed})
    return ServoDrivenModel(ARM, laws, (True,) * 3)


@pytest.fixture(params=list(SERVO_EXPORTERS))
def exporter(request: pytest.FixtureRequest):
    return SERVO_EXPORTERS[request.param]


def test_every_format_is_written_for_both_kinds_of_arm() -> None:
    assert list(SERVO_EXPORTERS) == list(EXPORTERS)


def test_it_has_a_place_or_a_reason_for_every_cause(exporter) -> None:
    assert set(exporter.places) == set(CAUSES)
    assert set(CAUSE_OF) == {p.name for p in LAW}
    assert set(CAUSE_OF.values()) < set(CAUSES)
    for place in exporter.places.values():
        nowhere = place.status == "not_representable"
        assert bool(place.element) != nowhere
        assert len(place.note) > 15 or place.status == "exact"


def test_exact_was_measured_below_one_percent(exporter) -> None:
    for name in (*SERVO_CASES, "surface_contact"):
        place, errors = exporter.places[name], exporter.measured(name)
        if place.status == "exact":
            assert all(share < EXACT for share in errors.values()), (name, errors)
        if exporter.torques.engine is not None and place.status != "not_representable":
            assert exporter.torques.engine in errors, f"{name} was never measured"


def test_it_writes_files_and_tells_of_causes_and_parameters(exporter, tmp_path: Path) -> None:
    before, after = driven(), driven(coulomb=0.4, delay=0.02, ki=3.0)
    cause = FoundCause("coulomb_friction", 1, "named", {"Fc": 0.4})
    model = ServoDrivenModel(ARM, after.laws, (True,) * 3, surface=SURFACE, causes=(cause,), before=before)
    written = export_model(model, EXPORTERS[exporter.name], tmp_path)
    assert all(path.stat().st_size for path in written.files)
    text = json.loads(write_export_json(written, tmp_path).read_text(encoding="utf-8"))
    assert text["driven_by"] == "position commands"
    assert [(e["effect"], e["joint"], e["parameters"]) for e in text["effects"]] == [
        ("coulomb_friction", ARM.joints[1], {"Fc": 0.4})
    ]
    told = {e["identified"]: e["acts_like"] for e in text["identified"]}
    integral = next(e["status"] for e in text["identified"] if e["identified"] == "ki")
    assert integral == ("exact" if exporter.name in ("mjcf", "pybullet") else "not_representable")
    assert told == {"ki": "gain_error", "delay": "command_delay", "surface": "surface_contact"}


def test_a_joint_that_feels_more_load_moves_as_one_with_less_of_all_else() -> None:
    laws = driven(load_gain=2.0, load_squared=0.1, saturation=0.2, coulomb=0.6).laws
    scaled = dict(zip((p.name for p in LAW), at_nominal_load(laws)[1], strict=True))
    assert (scaled["kp"], scaled["kd"], scaled["coulomb"], scaled["rotor"]) == (10.0, 0.75, 0.3, 0.05)
    assert (scaled["load_squared"], scaled["saturation"], scaled["load_gain"]) == (0.2, 0.4, 1.0)
    assert scaled["torque_limit"] == NO_LIMIT
    with pytest.raises(ModelError, match="feels no load"):
        servo_arm(driven(load_gain=0.0))


def test_the_limit_is_that_of_torque_or_of_full_duty() -> None:
    assert servo_arm(driven()).torque_limit[1] == np.inf
    assert servo_arm(driven(torque_limit=3.0, full_error=0.2)).torque_limit[1] == 3.0
    assert servo_arm(driven(full_error=0.2)).torque_limit[1] == pytest.approx(4.0)
    assert servo_arm(driven(full_error=0.2, saturation=0.25)).torque_limit[1] == pytest.approx(2.0)


def test_mjcf_alone_is_a_position_actuator_with_the_bias(tmp_path: Path) -> None:
    SERVO_EXPORTERS["mjcf"].write(servo_arm(driven(bias=0.05, offset=0.3, torque_limit=2.0)), tmp_path)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "model.xml"))
    data = mujoco.MjData(model)
    model.opt.gravity[:] = 0.0
    data.qpos[:], data.qvel[:] = (0.1, -0.2, 0.3), (0.5, 0.2, -0.1)
    data.ctrl[:3] = (0.2, -0.1, 0.3)
    mujoco.mj_forward(model, data)
    force = 20.0 * (data.ctrl[:3] - data.qpos - np.array([0.0, 0.05, 0.0])) - 1.5 * data.qvel
    np.testing.assert_allclose(data.qfrc_actuator, force + np.array([0.0, 0.3, 0.0]), atol=1e-12)
    np.testing.assert_allclose(model.actuator_forcerange[1], [-2.0, 2.0])
    np.testing.assert_allclose(model.dof_armature, 0.1)


def test_drake_holds_a_commanded_pose(tmp_path: Path) -> None:
    from pydrake.all import Simulator

    from lagnet.simulators.runtime.run_drake import build

    stiff = driven()
    stiff = ServoDrivenModel(ARM, np.tile(law_vector(kp=400.0, kd=40.0, rotor=0.1), (3, 1)), stiff.scale_is_set)
    SERVO_EXPORTERS["drake"].write(servo_arm(stiff), tmp_path)
    builder, plant = build(tmp_path)
    simulator = Simulator(builder.Build())
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    wanted, instance = np.array([0.2, -0.3, 0.4]), plant.GetJointByName(ARM.joints[0]).model_instance()
    plant.get_actuation_input_port().FixValue(context, np.zeros(3))
    plant.get_desired_state_input_port(instance).FixValue(context, np.append(wanted, np.zeros(3)))
    simulator.AdvanceTo(3.0)
    weight = ARM.gravity_torque(plant.GetPositions(context)[None])[0]
    np.testing.assert_allclose(400.0 * (wanted - plant.GetPositions(context)), weight, atol=1e-3)


def test_usd_and_isaac_lab_hold_the_gains(tmp_path: Path) -> None:
    from pxr import Usd

    from lagnet.simulators.exporters.usd import PER_DEGREE

    SERVO_EXPORTERS["isaaclab"].write(servo_arm(driven(kp=12.0, delay=0.012, torque_limit=3.0)), tmp_path)
    values = runpy.run_path(str(tmp_path / "actuators.py"))["SETTINGS"][ARM.joints[1]]
    assert values["kind"] == "delayed"
    assert values["values"]["stiffness"] == 12.0
    assert values["values"]["min_delay"] == 2
    assert values["values"]["effort_limit_sim"] == 3.0
    stage = Usd.Stage.Open(str(tmp_path / "model.usda"))
    drives = [p.GetAttribute("drive:angular:physics:stiffness").Get() for p in stage.Traverse()]
    assert [d for d in drives if d is not None] == pytest.approx([20 * PER_DEGREE, 12 * PER_DEGREE, 20 * PER_DEGREE])
