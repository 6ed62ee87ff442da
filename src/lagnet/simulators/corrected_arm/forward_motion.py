"""Motion of a corrected arm under joint torques: M(q) a = τ − h(q, v) − r(q, v), with joints that stick.

Moreau's midpoint rule: forces at the middle of a step, dry friction as an impulse that stops a joint as far as its
bound allows, so that sticking is exact and sliding second order in the step. Where a transmission gives, motor and link
are two coordinates. Source: acary2008.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.simulators.corrected_arm.arm_physics import ArmPhysics, BristleTerm
from lagnet.simulators.runtime.friction_impulse import friction_impulses
from lagnet.types import JointVector

MOTOR_SHARE = 0.05  # of the inertia about a joint: the rotor of a yielding transmission of which none is named
CORRECTIONS = 2  # of the speed at the middle of a step


@dataclass(frozen=True)
class Instant:
    """State of a moving arm at one moment, as encoders and drives see it.

    Args:
        q, v: shape (dof,), motor side of every joint, less what the encoder is off [rad, rad/s].
    """

    q: JointVector
    v: JointVector


def motor_inertia(arm: ArmPhysics) -> JointVector:
    """Rotor of each joint; at a yielding transmission without a named one a small share of what it moves, (dof,)."""
    usual = np.diagonal(arm.robot.mass_matrix(np.zeros((1, arm.n_dof)))[0])
    missing = arm.compliant & (arm.rotor <= 0.0)
    return np.where(missing, MOTOR_SHARE * usual, arm.rotor)


class ForwardMotion:
    """An arm that moves; torques are those at the joints.

    Args:
        arm: its physics.
        step: [s].
        q, v: shape (dof,), where it starts: encoder positions [rad] and speeds [rad/s].
    """

    def __init__(self, arm: ArmPhysics, step: float, q: JointVector, v: JointVector):
        self.arm, self.dt, self.n = arm, step, arm.n_dof
        self._split = np.flatnonzero(arm.compliant)
        self._port = np.arange(self.n)
        self._port[self._split] = self.n + np.arange(self._split.size)
        start = np.asarray(q, dtype=float) + arm.shift
        self._x = np.concatenate([start, start[self._split]])
        self._w = np.concatenate([v, np.asarray(v, dtype=float)[self._split]]).astype(float)
        self._rows = self._friction_rows()
        self._impulse = np.zeros(len(self._rows) + 2 * int(np.sum(arm.half_gap > 0.0)))
        self._bend = np.zeros(len(arm.bristles))
        self._load = np.zeros(self.n)
        self._rotors = self._rotor_block()

    @property
    def instant(self) -> Instant:
        """What encoders see now."""
        return Instant(self._x[self._port] - self.arm.shift, self._w[self._port])

    def advance(self, torque: JointVector, steps: int = 1) -> Instant:
        """Let some steps pass under constant joint torques [N m]."""
        for _ in range(steps):
            self._step(np.asarray(torque, dtype=float))
        return self.instant

    def _step(self, torque: JointVector) -> None:
        dt, x, w = self.dt, self._x, self._w
        middle = x + dt / 2.0 * w
        M = self._mass(middle)
        inverse = np.linalg.inv(M)
        rows, lower, upper, bias = self._bounded_rows(middle)
        new = w
        for _ in range(CORRECTIONS):
            pushed = self._push(torque, middle, (w + new) / 2.0)
            free = w + dt * inverse @ pushed
            new = free
            if len(rows):
                eased = rows @ inverse
                self._impulse = friction_impulses(
                    eased @ rows.T, rows @ free + bias, lower * dt, upper * dt, self._impulse
                )
                new = free + eased.T @ self._impulse
        if self.arm.load_friction.any():
            self._load = self._carried(middle, (w + new) / 2.0, (new - w) / dt)
        moved = dt / 2.0 * (w + new)
        self._bend = np.array([self._bent(t, b, moved) for t, b in zip(self.arm.bristles, self._bend, strict=True)])
        self._x, self._w = x + moved, new

    def _mass(self, x: np.ndarray) -> np.ndarray:
        size = self._x.size
        M = np.zeros((size, size))
        M[: self.n, : self.n] = self.arm.robot.mass_matrix(x[None, : self.n])[0]
        return M + self._rotors

    def _rotor_block(self) -> np.ndarray:
        block = np.zeros((self._x.size, self._x.size))
        matrix = self.arm.rotor_matrix() + np.diag(motor_inertia(self.arm) - self.arm.rotor)
        block[np.ix_(self._port, self._port)] = matrix
        return block

    def _push(self, torque: JointVector, x: np.ndarray, w: np.ndarray) -> np.ndarray:
        """Generalised forces without dry friction, shape of the coordinates."""
        arm, rest = self.arm, np.zeros((1, self.n))
        out = np.zeros(x.size)
        out[: self.n] = -arm.robot.inverse_dynamics(x[None, : self.n], w[None, : self.n], rest)[0]
        q, v = x[self._port] - arm.shift, w[self._port]
        out[self._port] += torque - joint_torque(arm, q, v)
        for term, bend in zip(arm.bristles, self._bend, strict=True):
            step = self.dt / 2.0 * w
            out[self._port[term.joint]] -= term.stiffness * self._bent(term, bend, step)
        for joint in self._split:
            if np.isfinite(arm.elasticity[joint]):
                wound = arm.elasticity[joint] * (x[self._port[joint]] - x[joint])
                wound += arm.twist_damping[joint] * (w[self._port[joint]] - w[joint])
                out[joint] += wound
                out[self._port[joint]] -= wound
        return out

    def _bent(self, term: BristleTerm, bend: float, moved: np.ndarray) -> float:
        """Bend of bristles after a movement, exact while its direction does not change."""
        way = moved[self._port[term.joint]]
        most = term.friction / term.stiffness
        return float(np.sign(way) * most + (bend - np.sign(way) * most) * np.exp(-abs(way) / most))

    def _carried(self, x: np.ndarray, w: np.ndarray, a: np.ndarray) -> JointVector:
        """Torque of bodies and rotors, the load that friction grows with, shape (dof,)."""
        n = self.n
        bodies = self.arm.robot.inverse_dynamics(x[None, :n], w[None, :n], a[None, :n])[0]
        return bodies + self.arm.rotor * a[self._port]

    def _friction_rows(self) -> list[tuple[np.ndarray, int, float]]:
        """Row of speeds that friction stops; its joint, or -1 with the friction of a coupled motor."""
        arm, rows = self.arm, []
        stribeck = {t.joint for t in arm.stribeck}
        for j in range(self.n):
            if arm.mean_friction[j] > 0.0 or arm.load_friction[j] > 0.0 or j in stribeck:
                row = np.zeros(self._x.size)
                row[self._port[j]] = 1.0
                rows.append((row, j, 0.0))
        for term in arm.couplings:
            if term.dry > 0.0:
                row = np.zeros(self._x.size)
                row[self._port] = arm.coupling_row(term)
                rows.append((row, -1, term.dry))
        return rows

    def _bounded_rows(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        speed = self._w[self._port]
        bound = dry_friction(self.arm, speed, self._load)
        rows, lower, upper, bias = [], [], [], []
        for row, joint, dry in self._rows:
            limit = dry if joint < 0 else bound[joint]
            for values, value in ((rows, row), (lower, -limit), (upper, limit), (bias, 0.0)):
                values.append(value)
        for joint in np.flatnonzero(self.arm.half_gap > 0.0):
            if np.isfinite(self.arm.elasticity[joint]):
                continue
            for side in (1.0, -1.0):
                row = np.zeros(self._x.size)
                row[joint], row[self._port[joint]] = side, -side
                room = self.arm.half_gap[joint] + side * (self._x[joint] - self._x[self._port[joint]])
                edge = max(room, 0.0) / self.dt
                for values, value in ((rows, row), (lower, 0.0), (upper, np.inf), (bias, edge)):
                    values.append(value)
        count = len(rows)
        if self._impulse.size != count:
            self._impulse = np.zeros(count)
        return np.reshape(rows, (count, self._x.size)), np.array(lower), np.array(upper), np.array(bias)


def joint_torque(arm: ArmPhysics, q: JointVector, v: JointVector) -> JointVector:
    """Torque that the motors must add for everything smooth at the joints, shape (dof,) [N m].

    Args:
        q: encoder positions [rad].
        v: speeds [rad/s].
    """
    torque = arm.viscous * v + arm.quadratic * v * np.abs(v) + arm.stiffness * (q - arm.spring_rest)
    torque = torque + arm.friction_bias
    for ripple in arm.ripples:
        torque[ripple.joint] += ripple.amplitude * np.sin(ripple.order * q[ripple.joint] + ripple.phase)
    for term in arm.couplings:
        row = arm.coupling_row(term)
        torque = torque + term.viscous * row * (row @ v)
    return torque


def friction_per_load(arm: ArmPhysics, v: JointVector, load: JointVector) -> JointVector:
    """Dry friction per torque of the load, shape (dof,): it may differ by whether motor or load drives."""
    return arm.load_friction + arm.load_friction_by_power * np.sign(load * v)


def dry_friction(arm: ArmPhysics, v: JointVector, load: JointVector) -> JointVector:
    """Largest torque with which dry friction holds or brakes each joint, shape (dof,) [N m]."""
    bound = arm.mean_friction + friction_per_load(arm, v, load) * np.abs(load)
    for term in arm.stribeck:
        bound[term.joint] += term.extra * np.exp(-((v[term.joint] / term.speed) ** 2))
    return bound
