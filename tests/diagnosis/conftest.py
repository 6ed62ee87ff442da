"""Small plants of their own: torque from the robot's bodies, with laws of left-out physics written by hand."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from lagnet.recordings.recording import Recording
from lagnet.rigid_body.random_arm import random_arm

RATE = 100.0  # [Hz]
NOISE = 0.01  # of each joint's usual torque
ENCODER = 1e-5  # [rad]
HARMONICS = 5

Law = Callable[[np.ndarray, np.ndarray, np.ndarray, np.ndarray], np.ndarray]
"""Torque (n, dof) that a law adds, from q, v, a and the torque of the bodies."""


@dataclass(frozen=True)
class Plant:
    """A robot with laws that its model lacks."""

    robot: Any
    laws: Sequence[Law] = ()
    noise: float = NOISE
    encoder: float = ENCODER

    def record(self, seed: int, seconds: float = 24.0, hold: Sequence[int] = (), one_way: Sequence[int] = ()):
        """What an encoder and a torque sensor write down of one motion.

        Args:
            seed: of motion and noise.
            seconds: length.
            hold: joints that stand still.
            one_way: joints that turn in the positive direction only.
        """
        rng, n = np.random.default_rng(seed), self.robot.n_dof
        time = np.arange(round(seconds * RATE)) / RATE
        omega = 2.0 * np.pi * 0.1 * np.arange(1, HARMONICS + 1)[:, None]
        size = rng.normal(0.0, 0.35, (HARMONICS, n)) / np.sqrt(np.arange(1, HARMONICS + 1))[:, None]
        phase, centre = rng.uniform(0.0, 2.0 * np.pi, (HARMONICS, n)), rng.uniform(-0.8, 0.8, n)
        size[:, list(hold)] = 0.0
        angle = omega * time[:, None, None] + phase
        q = centre + (size * np.sin(angle)).sum(axis=1)
        v, a = (size * omega * np.cos(angle)).sum(axis=1), -(size * omega**2 * np.sin(angle)).sum(axis=1)
        for joint in one_way:
            q[:, joint] += 3.0 * np.abs(v[:, joint]).max() * time
            v[:, joint] += 3.0 * np.abs(v[:, joint]).max()
        tau = self.torque(q, v, a)
        tau = tau + self.noise * self.usual_torque() * rng.standard_normal(tau.shape)
        return Recording(time, q + self.encoder * rng.standard_normal(q.shape), tau, self.robot.joints)

    def usual_torque(self) -> np.ndarray:
        """Scatter of each joint's body torque over poses and accelerations, shape (dof,)."""
        q, v, a = (np.random.default_rng(k).uniform(-1.0, 1.0, (400, self.robot.n_dof)) for k in range(3))
        return np.std(self.robot.inverse_dynamics(q, v, 4.0 * a), axis=0)

    def torque(self, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
        """Torque of bodies and laws."""
        body = self.robot.inverse_dynamics(q, v, a)
        return body + sum((law(q, v, a, body) for law in self.laws), np.zeros_like(body))


@pytest.fixture(scope="session")
def arm() -> Any:
    """Three revolute joints, drawn at random."""
    return random_arm(3, seed=12, kinds=("revolute",), fixed=False)


@pytest.fixture(scope="session")
def plant(arm) -> Callable[..., Plant]:
    """A plant of the random arm, or of another robot, with some laws."""
    return lambda *laws, robot=None: Plant(robot or arm, laws)


@pytest.fixture(scope="session")
def at() -> Callable[[int, Callable], Law]:
    """A law of one joint's own q, v, a and body torque as a law of the arm."""

    def of_joint(joint: int, law: Callable) -> Law:
        def added(q, v, a, body):
            out = np.zeros_like(q)
            out[:, joint] = law(q[:, joint], v[:, joint], a[:, joint], body[:, joint])
            return out

        return added

    return of_joint


@pytest.fixture(scope="session")
def names() -> Callable[[Any], set[tuple[str, str | None]]]:
    """Effect and joint of everything that a diagnosis names."""
    return lambda result: {(e.effect, e.joint) for e in result.effects}
