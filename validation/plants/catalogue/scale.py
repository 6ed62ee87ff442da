"""How large an effect must be to take a wanted share of the torque on a plant's own wanted motions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from validation.plants.arm.bodies import PinocchioBodies
from validation.plants.body import BodySettings, Payload, arm_joints, joint_limits
from validation.plants.motions import MotionSettings, Reference, reference
from validation.plants.sizes import Scale

LEAD = 0.5  # [s] before a recording starts, in which the arm and its gears settle
SMALL = 1e-3  # rad, step of differences by the joint angle
TINY_JOINT = 0.02  # of the largest torque of the arm: a joint below it is not where an effect is sized
RIGID_RATE = 50.0  # [Hz] at which wanted motions are looked at for sizes


@dataclass(frozen=True)
class OwnScale(Scale):
    """Root-mean-square figures of one plant's wanted motions; see `Scale`.

    Args:
        shift: shape (dof,), largest share of any joint's torque that 1 rad at this joint changes.
        bend: shape (dof,), the same for a bend of 1 rad rms that follows the joint's torque, its dynamics with it.
        heavier: shape (dof,), the same for doubling the mass of the joint's link.
        torques: shape (n, dof), rigid torque of the wanted motions [N m].
        flips: shape (dof,), share of the time that the torque spends on its rarer side.
        mean_inertia: shape (dof,), [kg m²].
        duration: of a recording [s].
    """

    shift: np.ndarray
    bend: np.ndarray
    heavier: np.ndarray
    torques: np.ndarray
    flips: np.ndarray
    mean_inertia: np.ndarray
    duration: float


def wanted_motions(
    robot: str, shapes: tuple[str, ...], seed: int, speed_share: float, duration: float, rate: float
) -> list[Reference]:
    """The reference of every recording of a plant, and of the lead before it."""
    settings = MotionSettings(duration + LEAD, rate, speed_share=speed_share)
    limits = joint_limits(robot)
    return [reference(s, limits, settings, np.random.default_rng([seed, i])) for i, s in enumerate(shapes)]


def own_scale(robot: str, motions: list[Reference]) -> OwnScale:
    """Sizes on some motions, from the rigid bodies alone."""
    q, v, a = (np.concatenate([getattr(m, name) for m in motions]) for name in "qva")
    bodies = PinocchioBodies(robot)
    tau = bodies.torque(q, v, a)
    level = np.maximum(_rms(tau), 1e-3)
    arm = list(arm_joints(robot))
    seen = [j for j in arm if level[j] >= TINY_JOINT * level.max()]
    inertia = np.mean([np.diag(bodies.inertia(row)) for row in q[::10]], axis=0)
    return OwnScale(
        torque=level,
        torque_rate=_rms(np.gradient(tau, motions[0].time[1] - motions[0].time[0], axis=0)),
        speed=_rms(v),
        drag_speed=_rms(v**2),
        acceleration=_rms(a),
        top_speed=np.abs(v).max(axis=0),
        middle=q.mean(axis=0),
        spread=q.std(axis=0),
        payload_share=_whole_arm(robot, BodySettings(payload=Payload(1.0, (0.0, 0.0, 0.06))), (q, v, a), tau, arm),
        tilt_share=_whole_arm(robot, BodySettings(tilt=(0.03, 0.03)), (q, v, a), tau, arm) / (0.03 * np.sqrt(2)),
        inertia=inertia,
        shift=np.array([_shift(bodies, (q, v, a), tau, level, j, seen) for j in range(level.size)]),
        bend=np.array([_bend(bodies, (q, v, a), tau, level, j, seen, motions) for j in range(level.size)]),
        heavier=np.array([_heavier(robot, bodies, (q, v, a), tau, level, j, seen) for j in range(level.size)]),
        torques=tau,
        flips=np.minimum(np.mean(tau > 0, axis=0), np.mean(tau < 0, axis=0)),
        mean_inertia=inertia,
        duration=float(motions[0].time[-1]) - LEAD,
    )


def _rms(x: np.ndarray) -> np.ndarray:
    return np.sqrt(np.mean(x**2, axis=0))


def _whole_arm(robot: str, settings: BodySettings, motion: tuple, tau: np.ndarray, arm: list[int]) -> float:
    changed = PinocchioBodies(robot, settings).torque(*motion) - tau
    return float(np.mean((_rms(changed) / np.maximum(_rms(tau), 1e-3))[arm[:-1]]))


def _shift(bodies: PinocchioBodies, motion: tuple, tau: np.ndarray, level: np.ndarray, j: int, seen: list) -> float:
    q, v, a = motion
    moved = q.copy()
    moved[:, j] += SMALL
    return float((_rms(bodies.torque(moved, v, a) - tau) / SMALL / level)[seen].max())


def _bend(
    bodies: PinocchioBodies,
    motion: tuple,
    tau: np.ndarray,
    level: np.ndarray,
    j: int,
    seen: list,
    motions: list[Reference],
) -> float:
    q, v, a = (x.copy() for x in motion)
    sizes = np.cumsum([m.time.size for m in motions])[:-1]
    step = motions[0].time[1] - motions[0].time[0]
    bend = [SMALL * piece / level[j] for piece in np.split(tau[:, j], sizes)]
    speed = [np.gradient(piece, step) for piece in bend]
    q[:, j] -= np.concatenate(bend)
    v[:, j] -= np.concatenate(speed)
    a[:, j] -= np.concatenate([np.gradient(piece, step) for piece in speed])
    return float((_rms(bodies.torque(q, v, a) - tau) / SMALL / level)[seen].max())


def _heavier(
    robot: str, bodies: PinocchioBodies, motion: tuple, tau: np.ndarray, level: np.ndarray, j: int, seen: list
) -> float:
    heavy = PinocchioBodies(robot, BodySettings(link_changes=((bodies.joints[j], 2.0, (0.0, 0.0, 0.0)),)))
    return float((_rms(heavy.torque(*motion) - tau) / level)[seen].max())
