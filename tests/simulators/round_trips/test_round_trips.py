"""Exported arms in their engines against the corrected model's own motion; all effects in validation/round_trip."""

from __future__ import annotations

import subprocess
import sys
from functools import cache, partial
from pathlib import Path

import numpy as np
import pytest

from lagnet.effects.catalogue import CATALOGUE
from lagnet.rigid_body.random_arm import random_arm
from lagnet.simulators.corrected_arm.arm_physics import ArmPhysics, arm_physics
from lagnet.simulators.engines.engine import Engine
from lagnet.simulators.engines.registry import engine_of
from lagnet.simulators.registry import EXPORTERS
from lagnet.simulators.round_trips.round_trip import case_of, control_of, engine_motion, reference_motion, size_of

ARM = random_arm(3, seed=5, kinds=("revolute",), fixed=False)
SECONDS, STEP = 0.8, 2.5e-4
EXACT = 0.012  # at a step 2.5 times that of the study, whose line is 0.01


@cache
def bare() -> np.ndarray:
    return reference_motion(arm_physics(ARM), control_of(ARM, SECONDS))


def opened(exporter: str, engine: str, folder: Path, arm: ArmPhysics) -> Engine:
    return engine_of(exporter, engine, folder, arm.robot.joints, STEP)


def share_of(name: str, exporter: str, engine: str, **changed: float) -> float:
    arm = arm_physics(case_of(ARM, name, None if CATALOGUE[name].whole_arm else 1, **changed))
    control = control_of(ARM, SECONDS)
    reference = reference_motion(arm, control)
    moved = engine_motion(EXPORTERS[exporter], arm, partial(opened, exporter, engine), control)
    return size_of(moved - reference) / size_of(reference - bare())


@pytest.mark.parametrize("name", ["coulomb_friction", "torque_ripple"])
def test_mujoco_moves_as_the_corrected_model(name: str) -> None:
    assert share_of(name, "mjcf", "mujoco") < EXACT


@pytest.mark.parametrize("name", ["stribeck_friction", "rotor_inertia"])
def test_pybullet_moves_as_the_corrected_model(name: str) -> None:
    assert share_of(name, "pybullet", "pybullet") < EXACT


@pytest.mark.parametrize(("exporter", "engine"), [("mjcf", "mujoco"), ("pybullet", "pybullet")])
def test_friction_per_torque_of_the_motor_moves_as_in_the_corrected_model(exporter: str, engine: str) -> None:
    assert share_of("load_dependent_friction", exporter, engine, side=1.0) < EXACT


def test_pybullet_ignores_friction_of_a_urdf_and_mujoco_does_not() -> None:
    assert share_of("coulomb_friction", "urdf", "pybullet") > 0.9
    assert share_of("coulomb_friction", "urdf", "mujoco") < 0.1


def test_exported_friction_holds_where_the_default_of_mujoco_creeps(tmp_path: Path) -> None:
    import mujoco

    arm = arm_physics(case_of(ARM, "coulomb_friction", 1))
    EXPORTERS["mjcf"].write(arm, tmp_path)
    moved = []
    for tight in (True, False):
        model = mujoco.MjModel.from_xml_path(str(tmp_path / "model.xml"))
        model.opt.gravity[:] = 0.0
        if not tight:
            model.dof_solref[:], model.dof_solimp[:] = (0.02, 1.0), (0.9, 0.95, 0.001, 0.5, 2.0)
        data = mujoco.MjData(model)
        data.ctrl[1] = 0.12
        for _ in range(2000):
            mujoco.mj_step(model, data)
        moved.append(abs(data.qpos[1]))
    assert moved[0] < 1e-5
    assert moved[1] > 100.0 * moved[0]


@pytest.mark.parametrize(("name", "script"), [("mjcf", "run_mujoco.py"), ("pybullet", "run_pybullet.py")])
def test_the_script_beside_a_model_runs_without_lagnet(name: str, script: str, tmp_path: Path) -> None:
    EXPORTERS[name].write(arm_physics(case_of(ARM, "stribeck_friction", 1)), tmp_path)
    code = "import sys; sys.modules['lagnet'] = None; import runpy; runpy.run_path(sys.argv[1], run_name='__main__')"
    done = subprocess.run(
        [sys.executable, "-c", f"import sys; sys.path.insert(0, {str(tmp_path)!r}); {code}", str(tmp_path / script)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert "after 1 s without torque" in done.stdout, done.stderr
