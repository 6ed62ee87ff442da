"""Arms whose model knows hardly anything of their links, and on which every joint has all that real joints have.

Torque is that of the true bodies by Newton–Euler, with all else written out here: dry friction that differs by
direction and grows with the load, Stribeck and viscous friction, a rotor and a ripple at every joint, a gas strut at
the second, and a slow disturbance that nothing predicts. The model has one mass for all links, as placeholders in a
URDF have.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.signal import lfilter

from lagnet.recordings.recording import Recording
from lagnet.rigid_body.random_arm import random_arm
from lagnet.rigid_body.robot import Robot
from validation.far_models.motion import harmonics

ENCODER, NOISE = 1e-5, 0.01  # [rad] or [m]; of each joint's usual torque
SHARP, STRIBECK = 1e-4, 0.1  # [rad/s] over which dry friction changes its direction, and by which its excess falls off
WAVES, RIPPLE = 17.0, 0.05  # of a ripple a radian, and its size over dry friction
PER_LOAD = 0.12  # largest friction that grows with the load, over the load: gears of 88 to 100 % efficiency
MEMORY, SLOW = 0.95, 0.15  # of a disturbance from sample to sample, and the size of its steps, over those of the torque
KINDS = (("revolute",), ("revolute", "revolute", "prismatic"))
MASSES = (1.0, 0.2)  # [kg] of every link of the model, in turn
STRUT, LEVER = 0.3, 1.2  # [rad] at which a strut has no lever, and how far its foot is, over that of its head


@dataclass(frozen=True, eq=False)
class WholeJoints:
    """A true arm and the model that is held against it.

    Args:
        nominal, true: robots of one kinematics.
        dry, viscous, stribeck, rotor: shapes (2, dof), (dof,), (dof,) and (dof,) of what the model lacks.
        per_load: shape (dof,), further dry friction over the torque of the bodies.
        strut: largest torque of the gas strut, about [N m].
    """

    nominal: Robot
    true: Robot
    dry: np.ndarray
    viscous: np.ndarray
    stribeck: np.ndarray
    rotor: np.ndarray
    per_load: np.ndarray
    strut: float

    def record(self, seed: int) -> Recording:
        """One motion with what an encoder and a torque sensor write down of it."""
        rng = np.random.default_rng(seed)
        time, q, v, a = harmonics(rng, self.true.n_dof)
        body = self.true.inverse_dynamics(q, v, a)
        tau = body + self._beside_bodies(q, v, a, self.per_load * np.abs(body))
        usual = np.std(tau, axis=0)
        tau = tau + usual * (NOISE * rng.standard_normal(tau.shape) + SLOW * _slow(rng.standard_normal(tau.shape)))
        return Recording(time, q + ENCODER * rng.standard_normal(q.shape), tau, self.true.joints)

    def _beside_bodies(self, q: np.ndarray, v: np.ndarray, a: np.ndarray, rub: np.ndarray) -> np.ndarray:
        rub = rub + self.stribeck * np.exp(-((v / STRIBECK) ** 2))
        up, down = (
            np.clip(sign * v / SHARP, 0.0, 1.0) * (dry + rub) for sign, dry in zip((1, -1), self.dry, strict=True)
        )
        ripple = RIPPLE * self.dry.mean(axis=0) * np.sin(WAVES * q)
        out = up - down + self.viscous * v + self.rotor * a + ripple
        out[:, 1] += self.strut * np.sin(q[:, 1] - STRUT) / (LEVER + np.cos(q[:, 1]))
        return out


def _slow(steps: np.ndarray) -> np.ndarray:
    return np.asarray(lfilter([1.0 - MEMORY], [1.0, -MEMORY], steps, axis=0))


def draw(seed: int) -> WholeJoints:
    """A plant by its number: five to seven joints, some of them prismatic in every second arm."""
    rng = np.random.default_rng([seed, 31])
    n = int(rng.integers(5, 8))
    true = random_arm(n, seed=6000 + seed, kinds=KINDS[seed % len(KINDS)], fixed=False)
    placeholders = np.zeros((n, 10))
    placeholders[:, 0], placeholders[:, [4, 6, 9]] = MASSES[seed // len(KINDS) % len(MASSES)], 1e-3
    usual = np.std(true.gravity_torque(rng.uniform(-1.0, 1.0, (300, n))), axis=0)
    size = np.maximum(usual, 0.1 * usual.max()) * rng.uniform(0.1, 1.5)
    return WholeJoints(
        true.with_inertial_parameters(placeholders),
        true,
        size * rng.uniform(0.8, 1.2, (2, n)),
        size * rng.uniform(0.15, 0.5, n),
        size * rng.uniform(0.0, 0.5, n),
        size * rng.uniform(0.0, 0.05, n),
        rng.uniform(0.0, PER_LOAD, n),
        float(usual[1] * rng.uniform(0.0, 1.0)),
    )
