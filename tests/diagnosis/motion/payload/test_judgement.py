"""A mass that MuJoCo hangs at the last of two links is named as one payload, with its size, centre and intervals."""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np
import pytest

from lagnet.diagnosis.motion.diagnose import diagnose_motion
from lagnet.diagnosis.motion.payload.entry import payload_abstention
from lagnet.diagnosis.motion.payload.fit import body_loads, body_of, possible
from lagnet.diagnosis.motion.problem import motion_rates, pose_motion_problem
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.inertia import is_physically_consistent
from lagnet.rigid_body.kinematic_tree import kinematic_tree
from lagnet.rigid_body.robot import Robot, load_description
from lagnet.servos.nominal import NominalServo, unknown_servo

ENCODER = 2.0 * np.pi / 4096.0
MASS, CENTRE = 0.2, np.array([0.0, 0.0, -0.1])
ROUNDED = 1e-9  # [N m]
LEG = """<mujoco><compiler angle="radian"/><default><joint axis="0 1 0" damping="0.15" frictionloss="0.03"
armature="0.01"/><position kp="8" kv="0.3"/></default><worldbody><body><joint name="upper"/>
<inertial pos="0 0 -0.08" mass="0.3" diaginertia="4e-4 4e-4 5e-5"/><body pos="0 0 -0.16"><joint name="lower"/>
<inertial pos="0 0 -0.08" mass="0.25" diaginertia="4e-4 4e-4 5e-5"/>{carried}</body></body></worldbody>
<actuator><position joint="upper"/><position joint="lower"/></actuator></mujoco>"""
CARRIED = '<body pos="0 0 -0.1"><inertial pos="0 0 0" mass="0.2" diaginertia="1e-9 1e-9 1e-9"/></body>'


def recorded(path: Path, seconds: float, seed: int) -> Recording:
    """Steps and sines at 50 Hz of a plant in a file, friction close to rigid."""
    model = mujoco.MjModel.from_xml_path(str(path))
    model.opt.timestep, model.opt.integrator = 0.001, mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    model.dof_solimp[:] = [0.9999, 0.9999, 0.001, 0.5, 2.0]
    data, time = mujoco.MjData(model), np.arange(0.0, seconds, 0.02)
    steps = np.random.default_rng(seed).uniform(-1.0, 1.0, (int(seconds / 2.0) + 1, 2))[(time / 2.0).astype(int)]
    waves = 0.6 * np.sin(2.0 * np.pi * (0.1 + 0.04 * time) * time)[:, None] * np.array([1.0, 0.7])
    command, q = np.where(time[:, None] % 16.0 < 8.0, steps, waves), np.empty((time.size, 2))
    for k in range(time.size):
        q[k], data.ctrl[:] = data.qpos, command[k]
        mujoco.mj_step(model, data, 20)
    return Recording(time, ENCODER * np.round(q / ENCODER), None, ("upper", "lower"), command=command, path=str(seed))


@pytest.fixture
def nominal(tmp_path) -> Robot:
    path = tmp_path / "leg.xml"
    path.write_text(LEG.format(carried=""), encoding="utf-8")
    return load_description(path)


@pytest.mark.slow
def test_a_payload_is_one_effect_of_the_arm_with_its_size(nominal, tmp_path):
    real = tmp_path / "real.xml"
    real.write_text(LEG.format(carried=CARRIED), encoding="utf-8")
    recordings = [recorded(real, 16.0, seed) for seed in (1, 2, 3)]
    found = diagnose_motion(recordings[:2], nominal, recordings[2:])
    assert [(e.effect, e.joint, e.tied_with) for e in found.effects] == [("payload", None, ())]
    (payload,) = found.effects
    assert payload.value("m") == pytest.approx(MASS, rel=0.05)
    assert payload.value("cz") == pytest.approx(CENTRE[2], rel=0.05)
    cy = next(p for p in payload.parameters if p.name == "cy")
    assert cy.ci95[1] - cy.ci95[0] > 1.0  # along the axes of both joints nothing shows where it is
    assert all(p.ci95[0] <= p.value <= p.ci95[1] for p in payload.parameters)
    carried = found.corrected.nominal.inertial_parameters()[-1] - nominal.inertial_parameters()[-1]
    assert carried[0] == pytest.approx(MASS, rel=0.05)
    assert all(e.rmse_corrected < 0.2 * e.rmse_nominal for e in found.verdict.errors)


def test_the_load_of_the_last_link_is_that_of_its_regressor(nominal, tmp_path):
    problem = pose_motion_problem([recorded(tmp_path / "leg.xml", 4.0, 0)], kinematic_tree(nominal))
    loads, body = body_loads(problem), body_of(np.array([MASS, *(MASS * CENTRE)]))
    q, point = np.column_stack([s.q for s in problem.series]), np.array([MASS, *(MASS * CENTRE)])
    a = motion_rates(problem.series[0].time, q)[1]
    loaded = nominal.with_inertial_parameters(nominal.inertial_parameters() + np.array([0.0 * body, body]))
    torque = loaded.inverse_dynamics(q, problem.speed, a) - nominal.armature * a
    for joint, series in enumerate(problem.series):
        found = loads.added(series, joint, point)
        assert np.abs(found.mass * a[:, joint] + found.load - torque[:, joint]).max() < ROUNDED


def test_a_mass_that_cannot_be_is_moved_to_one_that_can():
    for point in ([-1.0, 0.1, 0.0, 0.0], [0.1, 5.0, 0.0, 0.0]):
        assert is_physically_consistent(body_of(possible(np.array(point))), -1e-9)


def test_without_gains_a_payload_is_not_judged():
    assert [a.effect for a in payload_abstention(unknown_servo(np.zeros(2)))] == ["payload"]
    assert payload_abstention(NominalServo(unknown_servo(np.zeros(2)).laws, (True, True), "file")) == ()
