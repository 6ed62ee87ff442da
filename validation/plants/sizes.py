"""How large a hidden effect must be to take a wanted share of a joint's torque on a given motion."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from validation.plants.body import Body, BodySettings, Payload, arm_joints, joint_limits
from validation.plants.motions import MotionSettings, reference


@dataclass(frozen=True)
class Scale:
    """Root-mean-square figures of one robot on a typical motion, shape (dof,) each, in SI units."""

    torque: np.ndarray
    torque_rate: np.ndarray
    speed: np.ndarray
    drag_speed: np.ndarray
    acceleration: np.ndarray
    top_speed: np.ndarray
    middle: np.ndarray
    spread: np.ndarray
    payload_share: float  # mean over the arm of the rms torque of 1 kg over the joint's rms torque
    tilt_share: float  # the same for a base tilted by 1 rad
    inertia: np.ndarray


def _rms(x: np.ndarray) -> np.ndarray:
    return np.sqrt(np.mean(x**2, axis=0))


@lru_cache(maxsize=16)
def scale_of(robot: str) -> Scale:
    """Typical torques and speeds of a robot, from its rigid bodies alone."""
    settings = MotionSettings(rate=100.0)
    wanted = reference("fourier", joint_limits(robot), settings, np.random.default_rng(0))
    tau, M = _torques(robot, BodySettings(), wanted)
    loaded, _ = _torques(robot, BodySettings(payload=Payload(1.0, (0.0, 0.0, 0.06))), wanted)
    tilted, _ = _torques(robot, BodySettings(tilt=(0.03, 0.03)), wanted)
    arm = list(arm_joints(robot))
    level = np.maximum(_rms(tau), 1e-3)
    return Scale(
        torque=level,
        torque_rate=_rms(np.gradient(tau, 0.01, axis=0)),
        speed=_rms(wanted.v),
        drag_speed=_rms(wanted.v**2),
        acceleration=_rms(wanted.a),
        top_speed=np.abs(wanted.v).max(axis=0),
        middle=wanted.q.mean(axis=0),
        spread=wanted.q.std(axis=0),
        payload_share=float(np.mean((_rms(loaded - tau) / level)[arm[:-1]])),
        tilt_share=float(np.mean((_rms(tilted - tau) / level)[arm[:-1]]) / (0.03 * np.sqrt(2))),
        inertia=M,
    )


def _torques(robot: str, settings: BodySettings, wanted) -> tuple[np.ndarray, np.ndarray]:
    body = Body(robot, settings)
    rows = zip(wanted.q, wanted.v, wanted.a, strict=True)
    pairs = [(body.inertia(q), body.bias(q, v), a) for q, v, a in rows]
    body.close()
    tau = np.stack([M @ a + h for M, h, a in pairs])
    return tau, np.mean([np.diag(M) for M, _, _ in pairs], axis=0)
