"""Effects of the catalogue made to act in a simulation: at every step on the arm, or afterwards on the signal."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from lagnet.effects.catalogue import effect_named
from lagnet.effects.effect import Effect, Values
from lagnet.effects.motion import Motion
from lagnet.errors import EffectError, closest
from lagnet.rigid_body.robot import Robot
from lagnet.types import JointVector, Trajectory


@dataclass(frozen=True, eq=False)
class InjectedEffect:
    """One effect with its joint (index, None for the whole arm) and its parameters."""

    effect: Effect
    joint: int | None
    values: Values

    def torque(self, motion: Motion) -> Trajectory:
        """Torque that the effect adds to each joint, shape (n, dof)."""
        added = np.asarray(self.effect.torque(motion, self.joint, self.values))
        if added.ndim == 2:
            return added
        full = np.zeros_like(motion.q)
        full[:, self.joint] = added
        return full


def inject(robot: Robot, name: str, joint: str | None, values: Values, where: str | None = None) -> InjectedEffect:
    """Check one wanted effect against the catalogue and the robot.

    Args:
        robot: whose joints are meant.
        name: name of the catalogue.
        joint: joint name; None for effects of the whole arm.
        values: every parameter of the effect.
        where: the file and entry, for messages.

    Raises:
        EffectError: unknown name, joint or parameter, a value out of bounds, or an effect that has a hidden state.
    """
    effect = _known(name, where)
    if not effect.instantaneous and effect.stage != "signal":
        raise EffectError(f"{name} remembers the past and cannot be injected yet", where=where)
    index = _joint_index(robot, effect, joint, where)
    return InjectedEffect(effect, index, _checked_values(effect, effect.with_names_of_today(values), where))


def _known(name: str, where: str | None) -> Effect:
    try:
        return effect_named(name)
    except EffectError as error:
        raise EffectError(error.what, where=where, choices=error.choices, next_step=error.next_step) from None


def _joint_index(robot: Robot, effect: Effect, joint: str | None, where: str | None) -> int | None:
    if effect.whole_arm:
        if joint is not None:
            raise EffectError(f"{effect.name} acts on the whole arm and takes no joint, not {joint!r}", where=where)
        return None
    if joint is None:
        raise EffectError(f"{effect.name} needs a joint", where=where, choices=robot.joints)
    if joint not in robot.joints:
        near = closest(joint, robot.joints)
        raise EffectError(
            f"the robot has no joint {joint!r}",
            where=where,
            choices=robot.joints,
            next_step=f"did you mean {near}?" if near else None,
        )
    return robot.joints.index(joint)


def _checked_values(effect: Effect, values: Values, where: str | None) -> Values:
    names = [p.name for p in effect.parameters]
    for name in values:
        if name not in names:
            raise EffectError(f"{effect.name} has no parameter {name!r}", where=where, choices=names)
    missing = [name for name in names if name not in values]
    if missing:
        raise EffectError(f"{effect.name} lacks {', '.join(missing)}", where=where, choices=names)
    for p in effect.parameters:
        if not np.isfinite(values[p.name]) or not p.lower <= values[p.name] <= p.upper:
            raise EffectError(
                f"{effect.name}: {p.name} = {values[p.name]:g} is out of bounds, {p.lower:g} to {p.upper:g} {p.unit}",
                where=where,
            )
        if p.name in effect.settled and values[p.name] not in (p.lower, p.upper):
            raise EffectError(
                f"{effect.name}: {p.name} = {values[p.name]:g} chooses no form of the law",
                where=where,
                next_step=p.meaning,
            )
    if not effect.feasible(values):
        raise EffectError(f"{effect.name}: the parameters are physically impossible together", where=where)
    return {name: float(values[name]) for name in names}


@dataclass(frozen=True, eq=False)
class StepPhysics:
    """What the injected effects do to the arm at one instant.

    Args:
        robot: the nominal model.
        bodies: effects on the bodies; their torque is affine in the acceleration.
        joints: effects at the joints, each a function of its own joint's speed, given position and load.
        slow: shape (dof,), speed below which the sign of the velocity is blurred [rad/s].
    """

    robot: Robot
    bodies: tuple[InjectedEffect, ...]
    joints: tuple[InjectedEffect, ...]
    slow: JointVector

    @classmethod
    def of(cls, robot: Robot, effects: Iterable[InjectedEffect], slow: JointVector) -> StepPhysics:
        """The effects that act on the arm itself."""
        effects = tuple(effects)
        staged = {stage: tuple(e for e in effects if e.effect.stage == stage) for stage in ("body", "torque")}
        return cls(robot, staged["body"], staged["torque"], slow)

    @property
    def sliding(self) -> tuple[int, ...]:
        """Joints that an effect of the second kind acts on."""
        return tuple(sorted({e.joint for e in self.joints if e.joint is not None}))

    def body_torque(self, q: JointVector, v: JointVector) -> tuple[np.ndarray, np.ndarray]:
        """(r0, R) of the torque r0 + R a that changed bodies add, shapes (dof,), (dof, dof)."""
        dof = q.size
        if not self.bodies:
            return np.zeros(dof), np.zeros((dof, dof))
        rows = dof + 1
        probes = np.vstack([np.zeros(dof), np.eye(dof)])
        motion = self._motion(np.tile(q, (rows, 1)), np.tile(v, (rows, 1)), probes, np.zeros((rows, dof)))
        added = sum((e.torque(motion) for e in self.bodies), np.zeros((rows, dof)))
        return added[0], (added[1:] - added[0]).T

    def joint_torque(self, q: JointVector, speeds: np.ndarray, load: JointVector) -> np.ndarray:
        """Torque that the joint effects add at candidate speeds, shape (m, dof) in and out."""
        rows = speeds.shape[0]
        q_rows, load_rows = np.tile(q, (rows, 1)), np.tile(load, (rows, 1))
        motion = self._motion(q_rows, speeds, np.zeros_like(speeds), load_rows)
        return sum((e.torque(motion) for e in self.joints), np.zeros_like(speeds))

    def _motion(self, q: np.ndarray, v: np.ndarray, a: np.ndarray, load: np.ndarray) -> Motion:
        return Motion(np.zeros(q.shape[0]), q, v, a, load, self.slow, self.robot)


def seen_torque(
    effects: Iterable[InjectedEffect], robot: Robot, slow: JointVector, run: tuple[np.ndarray, ...]
) -> Trajectory:
    """The torque signal after gain, offset and delay, shape (n, dof), for a true run (time, q, v, a, tau)."""
    time, q, v, a, tau = run
    order = {"torque_gain": 0, "torque_offset": 1}  # scaled, then shifted, then late
    signal = [e for e in effects if e.effect.stage == "signal"]
    for entry in sorted(signal, key=lambda e: order.get(e.effect.name, 2)):
        tau = tau + entry.torque(Motion(time, q, v, a, tau, slow, robot))
    return tau
