"""A table under a MuJoCo arm is told as one surface at its height; without a table none is."""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np
import pytest

from lagnet.diagnosis.motion.diagnose import MotionDiagnosis, diagnose_motion
from lagnet.models.corrected.servo_files import load_servo_driven, save_servo_driven
from lagnet.recordings.recording import Recording
from lagnet.reports.motion_report import write_motion_report
from lagnet.rigid_body.robot import load_description

ENCODER = 2.0 * np.pi / 4096.0
TABLE = -0.27  # [m] below the shoulder; the arm reaches 0.32 m
ARM = """<mujoco><compiler angle="radian"/><default><joint axis="0 1 0" damping="{damping}" frictionloss="{dry}"
armature="0.01"/><position kp="8" kv="0.3"/><geom condim="1" contype="0" conaffinity="0"/></default><worldbody>{table}
<body><joint name="shoulder"/><inertial pos="0 0 -0.08" mass="0.3" diaginertia="4e-4 4e-4 5e-5"/>
<body pos="0 0 -0.16"><joint name="elbow"/><inertial pos="0 0 -0.08" mass="0.25" diaginertia="4e-4 4e-4 5e-5"/>
<geom type="sphere" size="0.005" pos="0 0 -0.155" mass="0" contype="1" conaffinity="1"/></body></body></worldbody>
<actuator><position joint="shoulder"/><position joint="elbow"/></actuator></mujoco>"""
PLANE = f'<geom type="plane" size="1 1 0.1" pos="0 0 {TABLE}" contype="1" conaffinity="1"/>'


def recorded(path: Path, seconds: float, seed: int) -> Recording:
    """Steps and slow turns at 50 Hz that now and then go below the table."""
    model = mujoco.MjModel.from_xml_path(str(path))
    model.opt.timestep, model.opt.integrator = 0.0005, mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    model.dof_solimp[:] = [0.9999, 0.9999, 0.001, 0.5, 2.0]
    data, time = mujoco.MjData(model), np.arange(0.0, seconds, 0.02)
    random = np.random.default_rng(seed)
    steps = random.uniform([0.2, -1.4], [1.3, 0.4], (int(seconds / 1.5) + 1, 2))[(time / 1.5).astype(int)]
    phase = random.uniform(0.0, 6.0, 2)
    waves = np.array([0.7, -0.5]) + np.array([0.6, 0.8]) * np.sin(time[:, None] * np.array([0.9, 1.4]) + phase)
    command, q = np.where(time[:, None] % 12.0 < 6.0, steps, waves), np.empty((time.size, 2))
    data.qpos[:] = command[0]
    for k in range(time.size):
        q[k], data.ctrl[:] = data.qpos, command[k]
        mujoco.mj_step(model, data, 40)
    q = ENCODER * np.round(q / ENCODER)
    return Recording(time, q, None, ("shoulder", "elbow"), command=command, path=str(seed))


def described(folder: Path, name: str, table: str, damping: float = 0.15, dry: float = 0.03) -> Path:
    path = folder / f"{name}.xml"
    path.write_text(ARM.format(table=table, damping=damping, dry=dry), encoding="utf-8")
    return path


def diagnosed(folder: Path, table: str, **plant: float) -> MotionDiagnosis:
    real, nominal = described(folder, "real", table, **plant), load_description(described(folder, "nominal", ""))
    recordings = [recorded(real, 24.0, seed) for seed in (1, 2, 3, 4)]
    return diagnose_motion(recordings[:3], nominal, recordings[3:])


@pytest.mark.slow
@pytest.mark.parametrize("dry", [0.03, 0.1])
def test_a_table_is_one_surface_at_its_height(tmp_path, dry):
    found = diagnosed(tmp_path, PLANE, dry=dry)
    (contact,) = (e for e in found.effects if e.joint is None)
    assert contact.effect == "surface_contact"
    assert contact.value("h") == pytest.approx(TABLE, abs=0.02)
    assert [
        e.effect for e in found.effects if e.joint is not None and not {"coulomb_friction"} & {e.effect, *e.tied_with}
    ] == []
    assert all(e.rmse_corrected < 0.4 * e.rmse_nominal for e in found.verdict.errors)
    again = load_servo_driven(save_servo_driven(found.corrected, tmp_path / "corrected"), load_description)
    assert np.array_equal(again.surface, found.corrected.surface)
    page = write_motion_report(found, tmp_path / "report.html").read_text(encoding="utf-8")
    assert "the whole arm" in page
    assert "level surface" in page


@pytest.mark.slow
def test_without_a_table_no_surface_is_in_the_correction(tmp_path):
    found = diagnosed(tmp_path, "", dry=0.1)
    assert found.corrected.surface is None
    assert all(e.effect != "surface_contact" for e in (*found.effects, *found.verdict.verdict.abstentions))


def test_one_short_recording_has_no_halves_and_is_diagnosed_all_the_same(tmp_path):
    real, nominal = described(tmp_path, "real", PLANE), load_description(described(tmp_path, "nominal", ""))
    found = diagnose_motion([recorded(real, 7.0, 1)], nominal)
    assert all(np.isfinite(e.rmse_corrected) for e in found.verdict.errors)
