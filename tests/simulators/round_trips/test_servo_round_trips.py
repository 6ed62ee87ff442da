"""Exported servo-driven arms in their engines against their models; all causes in validation/servo_round_trip."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from lagnet.rigid_body.random_arm import random_arm
from lagnet.simulators.corrected_arm.servo_arm import servo_arm
from lagnet.simulators.engines.servo_engines import servo_engine
from lagnet.simulators.round_trips.round_trip import size_of
from lagnet.simulators.round_trips.servo_cases import commands, plain_model, servo_case, start_of
from lagnet.simulators.round_trips.servo_round_trip import rolled_out, servo_engine_motion
from lagnet.simulators.servo_exporters.registry import SERVO_EXPORTERS

ARM = random_arm(3, seed=5, kinds=("revolute",), fixed=False)
SECONDS, STEP = 1.5, 5e-4
NEAR = 0.05  # at a step five times that of the study, whose line is .01


def share_of(name: str, exporter: str, engine: str) -> float:
    given = (*commands(SECONDS), start_of(ARM))
    without = rolled_out(plain_model(ARM), *given)
    model = servo_case(ARM, name, without)
    wanted = rolled_out(model, *given)
    return size_of(servo_engine_motion(model, exporter, engine, given, STEP) - wanted) / size_of(wanted - without)


@pytest.mark.parametrize("name", ["gain_error", "command_delay", "directional_load_friction", "dead_band"])
def test_mujoco_moves_as_the_model(name: str) -> None:
    assert share_of(name, "mjcf", "mujoco") < NEAR


@pytest.mark.parametrize("name", ["torque_offset", "stribeck_friction", "surface_contact"])
def test_pybullet_moves_as_the_model(name: str) -> None:
    assert share_of(name, "pybullet", "pybullet") < NEAR


@pytest.mark.parametrize("engine", ["mujoco", "pybullet"])
def test_a_late_command_holds_the_first_one_until_then(engine: str, tmp_path: Path) -> None:
    model = servo_case(ARM, "command_delay", np.zeros((1, 3)))
    SERVO_EXPORTERS[{"mujoco": "mjcf"}.get(engine, engine)].write(servo_arm(model), tmp_path)
    start, steps = np.array([0.0, 0.4, 0.0]), 40  # less than the delay
    sent = np.tile([0.0, 0.4, 0.0], (steps + 1, 1))
    wanted = model.rollout(sent, 1e-3 * np.arange(steps + 1), start, step=1e-4)[-1]
    with servo_engine(engine, tmp_path, 1e-3) as running:
        running.put(start, np.zeros(3))
        for k in range(steps):
            running.advance(sent[k], 1e-3)
        np.testing.assert_allclose(running.read()[0], wanted, atol=1e-3)


@pytest.mark.parametrize(("name", "script"), [("mjcf", "run_servo_mujoco.py"), ("pybullet", "run_servo_pybullet.py")])
def test_the_script_beside_a_model_runs_without_lagnet(name: str, script: str, tmp_path: Path) -> None:
    SERVO_EXPORTERS[name].write(servo_arm(servo_case(ARM, "gear_friction", np.zeros((1, 3)))), tmp_path)
    code = "import sys; sys.modules['lagnet'] = None; import runpy; runpy.run_path(sys.argv[1], run_name='__main__')"
    done = subprocess.run(
        [sys.executable, "-c", f"import sys; sys.path.insert(0, {str(tmp_path)!r}); {code}", str(tmp_path / script)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert "after 1 s with commands of zero" in done.stdout, done.stderr
