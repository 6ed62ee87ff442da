"""Motions whose every derivative is known exactly, and two models to move: a robot, and one without bodies."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from lagnet.effects.effect import Effect
from lagnet.effects.motion import Motion
from lagnet.rigid_body.robot import load_description

RATE = 250.0  # [Hz]
SAMPLES = 500
HARMONICS = 3
SLOW_SHARE = 0.02  # of the usual speed: the blurred speed of the joints


@dataclass(frozen=True)
class Springs:
    """Like a learned model: it answers the calls of InverseDynamics and knows nothing of links and frames."""

    joints: tuple[str, ...] = ("hip", "knee")

    @property
    def n_dof(self) -> int:
        return len(self.joints)

    def mass_matrix(self, q):
        cosine = np.cos(q[:, 1])
        first = np.stack([3.0 + 2.0 * cosine, 1.0 + cosine], axis=1)
        second = np.stack([1.0 + cosine, np.ones_like(cosine)], axis=1)
        return np.stack([first, second], axis=1)

    def coriolis_torque(self, q, v):
        sine = np.sin(q[:, 1])
        return np.stack([-sine * (2.0 * v[:, 0] * v[:, 1] + v[:, 1] ** 2), sine * v[:, 0] ** 2], axis=1)

    def gravity_torque(self, q):
        far = 4.0 * np.cos(q[:, 0] + q[:, 1])
        return np.stack([9.0 * np.cos(q[:, 0]) + far, far], axis=1)

    def inverse_dynamics(self, q, v, a):
        inertial = np.einsum("nij,nj->ni", self.mass_matrix(q), a)
        return inertial + self.coriolis_torque(q, v) + self.gravity_torque(q)


@dataclass(frozen=True)
class Sweep:
    """A motion, and the same motion at any other times: `at(time)` gives q, v, a."""

    motion: Motion
    at: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray, np.ndarray]]

    def load_at(self, time: np.ndarray) -> np.ndarray:
        """Torque of the model at any times."""
        return self.motion.model.inverse_dynamics(*self.at(time))


@pytest.fixture(scope="session")
def ur5() -> Any:
    return load_description("ur5")


@pytest.fixture(scope="session")
def springs() -> Springs:
    return Springs()


@pytest.fixture(scope="session")
def sweep() -> Callable[[Any, int], Sweep]:
    """Draws a motion of a model: sums of sines about a random pose."""

    def draw(model: Any, seed: int) -> Sweep:
        rng = np.random.default_rng(seed)
        centre = rng.uniform(-1.0, 1.0, model.n_dof)
        amplitude = rng.uniform(0.1, 0.5, (HARMONICS, model.n_dof))
        phase = rng.uniform(0.0, 2.0 * np.pi, (HARMONICS, model.n_dof))
        omega = 2.0 * np.pi * rng.uniform(0.6, 1.4, (HARMONICS, model.n_dof)) * (1.0 + np.arange(HARMONICS)[:, None])

        def at(time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
            angle = omega * np.asarray(time)[:, None, None] + phase
            size = amplitude / (1.0 + np.arange(HARMONICS)[:, None]) ** 2
            q = centre + (size * np.sin(angle)).sum(axis=1)
            v = (size * omega * np.cos(angle)).sum(axis=1)
            return q, v, -(size * omega**2 * np.sin(angle)).sum(axis=1)

        time = 3.0 + np.arange(SAMPLES) / RATE
        q, v, a = at(time)
        slow = SLOW_SHARE * np.sqrt(np.mean(v**2, axis=0))
        return Sweep(Motion(time, q, v, a, model.inverse_dynamics(q, v, a), slow, model), at)

    return draw


@pytest.fixture(scope="session")
def shapes_of() -> Callable[[Effect, Motion, int | None], tuple[Motion, list[dict[str, float]]]]:
    """Shapes of an effect with a motion that has them: some need a recorded plateau, some a residual to look at."""

    def found(effect: Effect, motion: Motion, joint: int | None) -> tuple[Motion, list[dict[str, float]]]:
        shapes = list(effect.shapes(motion, joint))
        if not shapes:
            limit = 0.6 * np.abs(motion.load).max(axis=0)
            motion = Motion(
                motion.time,
                motion.q,
                motion.v,
                motion.a,
                motion.load,
                motion.slow,
                motion.model,
                recorded=np.clip(motion.load, -limit, limit),
            )
            shapes = list(effect.shapes(motion, joint))
        if not shapes and joint is not None:
            wave = np.sin(60.0 * motion.q)
            shapes = list(effect.proposals(motion, joint, wave))
        return motion, shapes

    return found
