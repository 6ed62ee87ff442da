"""Arms whose model is far off: masses missing, halved or doubled, friction of ten times the gravity torque.

Torque is that of the true bodies by Newton–Euler, with friction written out here: dry friction that differs by
direction, viscous friction and a rotor at every joint.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.recordings.recording import Recording
from lagnet.rigid_body.random_arm import random_arm
from lagnet.rigid_body.robot import Robot
from validation.far_models.motion import harmonics

ENCODER, NOISE = 1e-5, 0.01  # [rad]; of each joint's usual torque
SHARP = 1e-4  # [rad/s] over which dry friction changes its direction
KINDS = {"missing": (0.02, 1.0), "half": (0.5, 1.0), "double": (2.0, 1.0), "mixed": (0.02, 0.5, 1.0, 2.0), "rough": ()}
FRICTION = {"usual": 0.3, "ten times": 10.0}  # dry friction over the usual gravity torque of the joint


@dataclass(frozen=True, eq=False)
class FarPlant:
    """A true arm and the model that is held against it.

    Args:
        kind: what is wrong with the masses.
        friction: how large friction is.
        nominal, true: robots of one kinematics.
        dry, viscous, rotor: shapes (2, dof), (dof,) and (dof,) of what the model lacks.
    """

    kind: str
    friction: str
    nominal: Robot
    true: Robot
    dry: np.ndarray
    viscous: np.ndarray
    rotor: np.ndarray

    def record(self, seed: int) -> Recording:
        """One motion with what an encoder and a torque sensor write down of it."""
        rng = np.random.default_rng(seed)
        time, q, v, a = harmonics(rng, self.true.n_dof)
        up = np.clip(v / SHARP, 0.0, 1.0) * self.dry[0] - np.clip(-v / SHARP, 0.0, 1.0) * self.dry[1]
        tau = self.true.inverse_dynamics(q, v, a) + up + self.viscous * v + self.rotor * a
        tau = tau + NOISE * np.std(tau, axis=0) * rng.standard_normal(tau.shape)
        return Recording(time, q + ENCODER * rng.standard_normal(q.shape), tau, self.true.joints)


def draw(seed: int) -> FarPlant:
    """A plant by its number: four to six joints, every kind of model in turn."""
    rng = np.random.default_rng([seed, 7])
    kind, friction = list(KINDS)[seed % len(KINDS)], list(FRICTION)[(seed // len(KINDS)) % len(FRICTION)]
    n = int(rng.integers(4, 7))
    true = random_arm(n, seed=1000 + seed, kinds=("revolute",), fixed=False)
    parameters = true.inertial_parameters()
    factors = rng.uniform(0.3, 3.0, n) if kind == "rough" else rng.choice(KINDS[kind], n)
    if kind != "rough":
        factors[rng.integers(n)] = KINDS[kind][0]  # at least one
    usual = np.std(true.gravity_torque(rng.uniform(-1.5, 1.5, (300, n))), axis=0)
    size = FRICTION[friction] * np.maximum(usual, 0.1 * usual.max())
    dry = size * rng.uniform(0.8, 1.2, (2, n))
    viscous, rotor = 0.5 * size * rng.uniform(0.3, 1.0, n), 0.05 * size * rng.uniform(0.0, 1.0, n)
    return FarPlant(
        kind, friction, true.with_inertial_parameters(parameters * factors[:, None]), true, dry, viscous, rotor
    )
