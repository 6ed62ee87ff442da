"""The case of docs/how_a_diagnosis_works.md: a small arm, three recordings, and what was left out of its model."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.models.corrected.model import CorrectedModel, NamedEffect
from lagnet.recordings.recording import Recording
from lagnet.rigid_body.random_arm import random_arm
from lagnet.rigid_body.robot import Robot

RATE, SECONDS, HARMONICS, BASE = 100.0, 24.0, 5, 0.1  # [Hz], [s], number, [Hz]
NOISE = 0.01  # of each joint's usual torque
ENCODER = 1e-5  # [rad]
SLOW = 0.01  # [rad/s], the ε of s(v) = tanh(v/ε)
PAYLOAD, FRICTION, BEARING, PUSH = 0.3, 0.6, 0.1, 6.0  # [kg], [N m], [N m/rad], [N]
CONTACT = (9.0, 13.0)  # [s] of the second recording


@dataclass(frozen=True)
class Case:
    """What the diagnosis is given, and the truth that it is not.

    Args:
        robot: the nominal model.
        fit, holdout: recordings.
        hidden: effects of the catalogue that the nominal model lacks. BEARING q_1 s(v_0), at the first joint, is in no
            catalogue.
    """

    robot: Robot
    fit: tuple[Recording, ...]
    holdout: tuple[Recording, ...]
    hidden: tuple[NamedEffect, ...]


def make_case() -> Case:
    """A load on the last link, dry friction at the second joint, a contact for a while, and a law in no catalogue."""
    robot = random_arm(3, seed=12, kinds=("revolute",), fixed=False)
    ball = 0.4 * PAYLOAD * 0.05**2
    load = {"m": PAYLOAD, "cx": 0.0, "cy": 0.0, "cz": 0.08}
    load |= {"Ixx": ball, "Ixy": 0.0, "Iyy": ball, "Ixz": 0.0, "Iyz": 0.0, "Izz": ball}
    lasting = (NamedEffect("payload", None, load), NamedEffect("coulomb_friction", 1, {"Fc": FRICTION}))
    push = {"Fx": 0.0, "Fy": 0.6 * PUSH, "Fz": -0.8 * PUSH, "px": 0.0, "py": 0.0, "pz": 0.1}
    contact = NamedEffect("contact_force", None, push, CONTACT)
    recordings = [_record(robot, lasting + ((contact,) if k == 1 else ()), k) for k in range(4)]
    return Case(robot, tuple(recordings[:3]), tuple(recordings[3:]), (*lasting, contact))


def _record(robot: Robot, hidden: tuple[NamedEffect, ...], number: int) -> Recording:
    rng, n = np.random.default_rng(number + 1), robot.n_dof
    time = np.arange(round(SECONDS * RATE)) / RATE
    omega = 2.0 * np.pi * BASE * np.arange(1, HARMONICS + 1)[:, None]
    size = rng.normal(0.0, 0.35, (HARMONICS, n)) / np.sqrt(np.arange(1, HARMONICS + 1))[:, None]
    angle = omega * time[:, None, None] + rng.uniform(0.0, 2.0 * np.pi, (HARMONICS, n))
    q = rng.uniform(-0.8, 0.8, n) + (size * np.sin(angle)).sum(axis=1)
    v, a = (size * omega * np.cos(angle)).sum(axis=1), -(size * omega**2 * np.sin(angle)).sum(axis=1)
    tau = CorrectedModel(robot, hidden, np.full(n, SLOW)).torque_along(time, q, v, a)
    tau[:, 0] += BEARING * q[:, 1] * np.tanh(v[:, 0] / SLOW)
    tau = tau + NOISE * np.std(tau, axis=0) * rng.standard_normal(tau.shape)
    return Recording(time, q + ENCODER * rng.standard_normal(q.shape), tau, robot.joints)
