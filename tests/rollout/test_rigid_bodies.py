"""Compiled bodies against Pinocchio, and a coupled arm against MuJoCo."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from tests.tolerances import ORACLE

from lagnet.rigid_body.kinematic_tree import kinematic_tree
from lagnet.rigid_body.robot import load_description
from lagnet.rollout.rigid_bodies import dynamics, workspace
from lagnet.rollout.whole_arm import roll_out_arm
from lagnet.servos.parameters import law_vector

NEARLY_RIGID = 3e-3  # [rad] MuJoCo's friction is a stiff constraint and its steps are of first order


@pytest.mark.parametrize("name", ["ur5", "panda"])
def test_mass_matrix_and_bias_are_those_of_pinocchio(name):
    robot = load_description(name)
    tree, n = kinematic_tree(robot).arrays(), robot.n_dof
    rng = np.random.default_rng(0)
    q, v = rng.normal(size=(2, 20, n))
    mass, bias, work = np.empty((n, n)), np.empty(n), workspace(n)
    expected = robot.inverse_dynamics(q, v, np.zeros_like(q))
    for k, m in enumerate(robot.mass_matrix(q)):
        dynamics(tree, q[k], v[k], mass, bias, work)
        assert np.abs(mass - m).max() < ORACLE
        assert np.abs(bias - expected[k]).max() < ORACLE * 10.0


def test_a_coupled_arm_moves_as_in_mujoco(tmp_path):
    path = tmp_path / "arm.xml"
    path.write_text(ARM, encoding="utf-8")
    robot, model = load_description(path), mujoco.MjModel.from_xml_path(str(path))
    model.opt.timestep, model.opt.integrator = 0.0005, mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    model.dof_solimp[:] = [0.9999, 0.9999, 0.001, 0.5, 2.0]
    data = mujoco.MjData(model)
    time = np.arange(0.0, 6.0, 0.02)
    command = np.column_stack([0.8 * np.sign(np.sin(2.0 * time)), 0.6 * np.sin(5.0 * time)])
    measured = np.empty_like(command)
    for k in range(time.size):
        measured[k] = data.qpos
        data.ctrl[:] = command[k]
        mujoco.mj_step(model, data, 40)
    law = law_vector(kp=20.0, kd=1.0, coulomb=0.15, viscous=0.2, rotor=0.02, torque_limit=3.0)
    q = roll_out_arm(kinematic_tree(robot), np.array([law, law]), time, command, np.zeros(2), step=0.001)
    assert np.sqrt(np.mean((q - measured) ** 2)) < NEARLY_RIGID


ARM = """<mujoco><compiler angle="radian"/><default>
<joint damping="0.2" frictionloss="0.15" armature="0.02"/><position kp="20" kv="1" forcerange="-3 3"/></default>
<worldbody><body><joint name="a" axis="0 1 0"/><inertial pos="0.1 0 0" mass="0.4" diaginertia="1e-3 2e-3 2e-3"/>
<body pos="0.2 0 0"><joint name="b" axis="0 1 0"/><inertial pos="0.1 0 0.02" mass="0.3" diaginertia="1e-3 2e-3 2e-3"/>
</body></body></worldbody>
<actuator><position joint="a"/><position joint="b"/></actuator></mujoco>"""
