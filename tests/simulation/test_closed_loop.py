"""The engine agrees with Pinocchio, torque and motion belong to one instant, and each injected law is what is seen."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import savgol_filter

from lagnet.effects.motion import Motion
from lagnet.rigid_body.robot import Robot, load_description
from lagnet.simulation.closed_loop import LoopSettings, TrueRun, run_closed_loop
from lagnet.simulation.injection import InjectedEffect, StepPhysics, inject
from lagnet.simulation.motions import MotionSettings, draw_motion
from lagnet.simulation.pybullet_arm import PyBulletArm
from lagnet.simulation.simulate import SimulationSettings, simulate

ENGINE = 1e-8  # of the largest entry: two algorithms in float64, bodies handed over as text
LAW = 0.003  # of the joint's torque: the share of a step by which friction leads, times the motion's highest frequency
SMOOTH = 0.003  # of the joint's torque: a half-step offset between torque and motion would exceed it
SLOW = 0.005
BODY = {
    "m": 1.2,
    "cx": 0.0,
    "cy": 0.02,
    "cz": 0.05,
    "Ixx": 2e-3,
    "Iyy": 2e-3,
    "Izz": 2e-3,
    "Ixy": 0,
    "Iyz": 0,
    "Ixz": 0,
}
CASES = [
    [("viscous_friction", "elbow_joint", {"Fv": 3.0})],
    [("coulomb_friction", "wrist_3_joint", {"Fc": 0.5})],
    [("stribeck_friction", "elbow_joint", {"Fc": 1.0, "Fs": 1.0, "vs": 0.1})],
    [("asymmetric_friction", "wrist_1_joint", {"Fc_plus": 0.3, "Fc_minus": 0.6})],
    [("quadratic_drag", "shoulder_pan_joint", {"Fd": 2.0})],
    [("joint_spring", "wrist_2_joint", {"k": 1.0, "q0": 0.3})],
    [("rotor_inertia", "wrist_3_joint", {"Ia": 0.2})],
    [("payload", None, BODY)],
    [("gravity_tilt", None, {"theta_1": 0.05, "theta_2": -0.03})],
    [("coulomb_friction", "wrist_1_joint", {"Fc": 0.5}), ("coulomb_friction", "wrist_2_joint", {"Fc": 0.4})],
]


def _rms(x: np.ndarray) -> np.ndarray:
    return np.sqrt(np.mean(x**2, axis=0))


def _run(robot: Robot, effects: list[InjectedEffect]) -> TrueRun:
    wanted = draw_motion(robot, "random_moves", MotionSettings(duration=2.5), 4)
    physics = StepPhysics.of(robot, effects, np.full(robot.n_dof, SLOW))
    return run_closed_loop(robot, physics, wanted, LoopSettings())


@pytest.mark.parametrize("name", ["ur5", "ur10", "panda", "xarm7", "kinova", "z1"])
def test_the_engine_has_the_bodies_of_the_description(name: str) -> None:
    robot = load_description(name)
    rng = np.random.default_rng(1)
    with PyBulletArm(robot, 1e-3) as arm:
        for _ in range(3):
            q, v, a = rng.uniform(-1, 1, (3, robot.n_dof))
            M, h = robot.mass_matrix(q[None])[0], robot.inverse_dynamics(q[None], v[None], 0 * a[None])[0]
            assert np.abs(arm.mass_matrix(q) - M).max() <= ENGINE * np.abs(M).max()
            assert np.abs(arm.bias_torque(q, v) - h).max() <= ENGINE * np.abs(h).max()
            arm.put(q, v)
            arm.advance(M @ a + h)
            assert np.abs((arm.state()[1] - v) / arm.step - a).max() <= 1e-6  # no damping, motor or stop in the way


@pytest.mark.parametrize("case", CASES, ids=lambda case: "+".join(e[0] for e in case))
def test_what_the_torque_has_beyond_the_rigid_bodies_is_the_injected_law(ur5: Robot, case: list) -> None:
    effects = [inject(ur5, *entry) for entry in case]
    run = _run(ur5, effects)
    load = ur5.inverse_dynamics(run.q, run.v, run.a)
    motion = Motion(run.time, run.q, run.v, run.a, load, np.full(ur5.n_dof, SLOW), ur5)
    law = sum(e.torque(motion) for e in effects)
    scale = np.maximum(_rms(run.tau), 1e-9)
    assert (_rms(law) / scale).max() > 0.01  # the effect is there
    assert (_rms(run.tau - load - law) / scale).max() <= LAW


def test_torque_and_motion_belong_to_the_same_instant(ur5: Robot) -> None:
    run = _run(ur5, [])
    step = run.time[1] - run.time[0]
    second_difference = (run.q[2:] - 2 * run.q[1:-1] + run.q[:-2]) / step**2
    assert np.abs(second_difference - run.a[1:-1]).max() <= 1e-6
    shifts = np.arange(-3, 4)
    errors = [
        _rms(run.tau[10 + s : s - 10] - ur5.inverse_dynamics(run.q[10:-10], run.v[10:-10], run.a[10:-10])).sum()
        for s in shifts
    ]
    assert shifts[int(np.argmin(errors))] == 0


def test_smoothed_recordings_reproduce_the_torque(ur5: Robot, clean: SimulationSettings) -> None:
    recording = simulate(ur5, (), clean).recordings[0]
    smooth = {"window_length": 9, "polyorder": 4, "delta": 1e-3, "axis": 0}
    v, a = (savgol_filter(recording.q, deriv=d, **smooth) for d in (1, 2))
    inner = slice(20, -20)
    error = recording.tau[inner] - ur5.inverse_dynamics(recording.q, v, a)[inner]
    assert (_rms(error) / _rms(recording.tau)).max() <= SMOOTH


def test_the_arm_follows_the_wanted_motion(ur5: Robot) -> None:
    wanted = draw_motion(ur5, "random_moves", MotionSettings(duration=2.5), 4)
    assert np.abs(_run(ur5, []).q - wanted.q).max() < 1e-6
    loaded = _run(ur5, [inject(ur5, "viscous_friction", "elbow_joint", {"Fv": 3.0})])
    assert np.abs(loaded.q - wanted.q).max() < 0.05  # the controller does not know the friction, yet keeps on course
