"""Sets whose truth is known: an arm that moves, and two files of it, off in bodies, friction, rotors or servos."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from lagnet.comparison.compare import Comparison, compare
from lagnet.comparison.motion import MotionComparison, compare_motion
from lagnet.comparison.resolution import folded_rotors
from lagnet.models.corrected.servo_driven import ServoDrivenModel
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.random_arm import random_arm
from lagnet.rigid_body.robot import Robot
from lagnet.servos.parameters import INDEX, law_vector

DOF, RATE, SECONDS = 3, 100.0, 40.0
LEVELS = (0.0, 0.03, 0.1, 0.3)  # relative errors of bodies and rotors
NOISE = 0.01  # of each joint's torque
CLOSE = 1.1  # ratio of true errors below which either set is right
CLEAR = 1.5  # ratio from which a joint ought to be decided
SERVO = {"kp": 18.0, "kd": 0.5, "viscous": 0.5, "coulomb": 0.06, "rotor": 0.03}
FACTOR = 50.0  # by which published numbers of one servo disagree at most


@dataclass(frozen=True)
class Graded:
    """Joints and parameters of one case: a joint's true ratio of errors, what was said, and what the baseline says."""

    ratio: list[float]
    said: list[str]
    baseline: list[str]
    covered: list[bool]
    agrees: list[bool]


def changed(robot: Robot, level: float, rng: np.random.Generator) -> Robot:
    """Every body scaled by its own factor, which keeps it physical, and every rotor by its own."""
    factors = 1.0 + level * rng.standard_normal((robot.n_dof, 1)).clip(-2.0, 2.0)
    rotors = robot.armature * (1.0 + level * rng.standard_normal(robot.n_dof).clip(-2.0, 2.0))
    return robot.with_inertial_parameters(robot.inertial_parameters() * factors).with_armature(rotors)


def motion(seed: int, seconds: float, dof: int = DOF) -> tuple[np.ndarray, ...]:
    """Sums of four sines: time, q, v, a."""
    rng = np.random.default_rng([seed, 3])
    time = np.arange(round(seconds * RATE)) / RATE
    omega, phase = 2 * np.pi * rng.uniform(0.1, 0.7, (4, dof)), rng.uniform(0.0, 2 * np.pi, (4, dof))
    size, turn = rng.uniform(0.1, 0.35, (4, dof)), omega * time[:, None, None]
    q = (size * np.sin(turn + phase)).sum(axis=1)
    v = (size * omega * np.cos(turn + phase)).sum(axis=1)
    return time, q, v, -(size * omega**2 * np.sin(turn + phase)).sum(axis=1)


def torque_case(seed: int) -> Graded:
    """One arm with friction and rotors, two sets with bodies and rotors off by their own level."""
    rng = np.random.default_rng([seed, 11])
    arm = random_arm(DOF, seed=seed, kinds=("revolute",), fixed=False)
    inertia = np.diagonal(arm.mass_matrix(np.zeros((1, DOF)))[0])
    arm = arm.with_armature(rng.uniform(0.1, 0.4, DOF) * inertia)
    sets = [changed(arm, float(rng.choice(LEVELS)), rng) for _ in range(2)]
    time, q, v, a = motion(seed, SECONDS)
    rigid = arm.inverse_dynamics(q, v, a)
    level = rigid.std(axis=0)
    tau = rigid + 0.1 * level * np.tanh(v / 1e-3) + 0.1 * level * v + 0.05 * level
    tau = tau + NOISE * level * rng.standard_normal(tau.shape)
    recording = Recording(time, q + 2e-6 * rng.standard_normal(q.shape), tau, arm.joints)
    found = compare(sets, ["a", "b"], [recording], seed)
    _, *apart = motion(seed + 1000, 120.0)
    truth = np.array([np.std(s.inverse_dynamics(*apart) - arm.inverse_dynamics(*apart), axis=0) for s in sets])
    part = slice(2 * len(time) // 3, None)
    raw = np.array([np.mean((tau[part] - s.inverse_dynamics(q, v, a)[part]) ** 2, axis=0) for s in sets])
    covered, agrees = _parameters(found, arm)
    return _graded(truth, found, raw, covered, agrees)


def _parameters(found: Comparison, arm: Robot) -> tuple[list[bool], list[bool]]:
    """Of parameters in which the sets differ: whether the interval holds the truth; whether the set is the nearest."""
    assert found.parameters is not None
    resolution, base = found.parameters, found.parameters.base
    folded, rotors = folded_rotors(arm, base)
    bodies = base.of(arm.inertial_parameters()) + arm.armature @ folded
    truth = np.concatenate([bodies, np.full(2 * arm.n_dof, np.nan), arm.armature[rotors]])
    covered, agrees = [], []
    for k in resolution.differing.tolist():
        if not np.isfinite(resolution.error[k]) or np.isnan(truth[k]):
            continue
        covered.append(bool(abs(resolution.estimate[k] - truth[k]) <= 1.96 * resolution.error[k]))
    told = {d.parameter: d for d in found.differences or ()}
    for name, true in zip(resolution.names, truth, strict=True):
        entry = told.get(name)
        if entry is not None and entry.resolved and entry.nearest is not None:
            away = [abs(value - true) for value in entry.values]
            agrees.append(bool(away[entry.nearest] <= CLOSE * min(away)))
    return covered, agrees


def motion_case(seed: int) -> Graded:
    """One arm of servos; two sets whose servo parameters are off by factors of up to fifty each."""
    rng = np.random.default_rng([seed, 12])
    arm = random_arm(DOF, seed=seed, kinds=("revolute",), fixed=False)
    laws = np.tile(law_vector(**SERVO), (DOF, 1))
    sets = []
    for _ in range(2):
        own, spread = laws.copy(), float(rng.choice((0.0, 0.05, 0.4, 1.0)))
        for name in SERVO:
            own[:, INDEX[name]] *= FACTOR ** (spread * rng.uniform(-1.0, 1.0))
        sets.append(ServoDrivenModel(arm, own, (True,) * DOF))
    true = ServoDrivenModel(arm, laws, (True,) * DOF)
    recording, apart = (_driven(true, s) for s in (seed, seed + 1000))
    found = compare_motion(sets, ["a", "b"], [recording], seed)
    rolled = [s.rollout(np.array(apart.command), apart.time, apart.q[0]) for s in sets]
    truth = np.array([np.sqrt(np.mean((r - apart.q) ** 2, axis=0)) for r in rolled])
    again = [s.rollout(np.array(recording.command), recording.time, recording.q[0]) for s in sets]
    raw = np.array([np.mean((r - recording.q) ** 2, axis=0) for r in again])
    covered, agrees = _servo_parameters(found, laws)
    return _graded(truth, found, raw, covered, agrees)


def _driven(model: ServoDrivenModel, seed: int) -> Recording:
    """Sines and steps at 50 Hz, positions as an encoder of 4096 steps reads them."""
    time, q, *_ = motion(seed, SECONDS)
    time, wave = time[::2], 0.6 * q[::2]
    pace = np.random.default_rng([seed, 4]).uniform(0.6, 1.6, DOF)
    command = wave + 0.1 * np.sign(np.sin(time[:, None] * pace))
    step = 2 * np.pi / 4096
    moved = model.rollout(command, time, command[0])
    return Recording(time, np.round(moved / step) * step, None, model.joints, command=command)


def _servo_parameters(found: MotionComparison, laws: np.ndarray) -> tuple[list[bool], list[bool]]:
    covered, agrees = [], []
    for entry in found.differences:
        name, joint = entry.parameter.rstrip(")").split("(")
        true = laws[list(j.joint for j in found.joints).index(joint), INDEX[name]]
        if np.isfinite(entry.error):
            covered.append(bool(abs(entry.estimate - true) <= 1.96 * entry.error))
        if entry.resolved and entry.nearest is not None:
            away = [abs(value - true) for value in entry.values]
            agrees.append(bool(away[entry.nearest] <= CLOSE * min(away)))
    return covered, agrees


def _graded(truth: np.ndarray, found: Any, raw: np.ndarray, covered: list[bool], agrees: list[bool]) -> Graded:
    ratio, said, baseline = [], [], []
    for joint, errors, ranked in zip(found.joints, truth.T, raw.T, strict=True):
        small = max(float(errors.min()), 1e-12)
        ratio.append(min(float(errors.max()) / small, 1e6) if errors.max() > 0.0 else 1.0)
        right = int(np.argmin(errors))
        said.append("undecided" if joint.also or joint.alike else grade(joint.best, right, ratio[-1]))
        baseline.append(grade(int(np.argmin(ranked)), right, ratio[-1]))
    return Graded(ratio, said, baseline, covered, agrees)


def grade(said: int, right: int, ratio: float) -> str:
    """right or wrong; of two sets that are nearly alike either is right."""
    return "right" if said == right or ratio < CLOSE else "wrong"
