"""Closed loop and forward dynamics of the true arm, leapfrog in time, links and motors solved together.

Speeds live half a step before positions; a force that depends on speed is evaluated at the instant of the position,
linearly implicit; dry surfaces are solved so that a joint that can be held is held. The centred second difference of
the positions is exactly the acceleration that the torques of the row made.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from validation.plants.arm.bodies import PinocchioBodies
from validation.plants.arm.controllers import Controller
from validation.plants.arm.events import Grasp
from validation.plants.arm.gears import Gear
from validation.plants.arm.pulls import Pull
from validation.plants.arm.surfaces import Surface
from validation.plants.body import Body
from validation.plants.motions import Reference

SWEEPS = 6  # over several surfaces at once


@dataclass(frozen=True, eq=False)
class Arm:
    """What the true arm is made of; every cause is listed with the number of the hidden effect that it is.

    Args:
        bodies: the true ones.
        engine: PyBullet's copy of them, where it integrates the links; None: the loop does.
        armature: shape (dof,), inertia that the motors add [kg m²].
        grasps: loads that the bodies carry for a while; not where PyBullet integrates.
        offset: shape (dof,), true angle less what the encoder says [rad].
    """

    bodies: PinocchioBodies
    armature: np.ndarray
    offset: np.ndarray
    engine: Body | None = None
    pulls: tuple[tuple[int, Pull], ...] = ()
    surfaces: tuple[tuple[int, Surface], ...] = ()
    gears: tuple[tuple[int, Gear], ...] = ()
    grasps: tuple[Grasp, ...] = ()

    def bodies_at(self, t: float) -> PinocchioBodies:
        """The bodies that move at time t [s]."""
        held = [grasp.bodies for grasp in self.grasps if grasp.start <= t < grasp.end]
        return held[0] if held else self.bodies


@dataclass(frozen=True, eq=False)
class TrueRun:
    """One run at the plant's step, shape (n, dof) each, on the side of the motors where a gear lies between.

    `tau` is what the motors give, less what the rotors of two-mass gears take. `own` holds, by number of the hidden
    effect, the torque that its pulls and surfaces cost.
    """

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    tau: np.ndarray
    step: float
    own: dict[int, np.ndarray] = field(default_factory=dict)


def run(arm: Arm, wanted: Reference, controller: Controller, step: float) -> TrueRun:
    """Follow a reference."""
    n, dof = wanted.q.shape
    state = _State(arm, wanted, step)
    seen = np.empty((4, n, dof))
    own = {number: np.zeros((n, dof)) for number, _ in (*arm.pulls, *arm.surfaces)}
    for _, pull in arm.pulls:
        pull.reset()
    for k in range(n):
        q, v = state.at_motors()
        tau = controller.torque(k, q - arm.offset, v)
        a_before = state.a[state.side]
        a = state.advance(k * step, tau, controller.damping, {number: rows[k] for number, rows in own.items()})
        tau = tau - controller.damping * step / 2 * (a - a_before)
        seen[:, k] = q, state.speed_at_motors(), a, state.shown(tau, a)
    return TrueRun(seen[0], seen[1], seen[2], seen[3], step, own)


class _State:
    """Angles and half-step speeds of links, then of the motors of two-mass gears."""

    def __init__(self, arm: Arm, wanted: Reference, step: float) -> None:
        self.arm, self.step, self.dof = arm, step, wanted.q.shape[1]
        self.elastic = [gear.joint for _, gear in arm.gears]
        self.side = np.arange(self.dof)
        self.side[self.elastic] = self.dof + np.arange(len(self.elastic))
        start = np.r_[np.arange(self.dof), self.elastic].astype(int)
        self.x = (wanted.q[0] + arm.offset)[start]
        self.v = (wanted.v[0] - step / 2 * wanted.a[1])[start]
        self.a = wanted.a[1][start].copy()
        size = start.size
        self.M = np.zeros((size, size))
        self.rotors = np.array([gear.rotor for _, gear in arm.gears])
        self.M[range(self.dof, size), range(self.dof, size)] = self.rotors
        self.load = np.zeros(self.dof)
        self._bend(wanted)
        if arm.engine is not None:
            arm.engine.put(self.x[: self.dof], self.v[: self.dof])

    def _bend(self, wanted: Reference) -> None:
        """Let gears start as bent as the first torque bends them."""
        links = slice(0, self.dof)
        torque = self.arm.bodies.inertia(self.x[links]) @ self.a[links] + self.arm.bodies.bias(
            self.x[links], self.v[links]
        )
        for e, (_, gear) in enumerate(self.arm.gears):
            carried = torque[gear.joint]
            self.x[self.dof + e] += carried / gear.stiffness + np.sign(carried) * gear.half_gap

    def at_motors(self) -> tuple[np.ndarray, np.ndarray]:
        self.v_mid = self.v + self.step / 2 * self.a
        return self.x[self.side], self.v_mid[self.side]

    def speed_at_motors(self) -> np.ndarray:
        return self.v_mid_exact[self.side]

    def shown(self, tau: np.ndarray, a: np.ndarray) -> np.ndarray:
        if not self.elastic:
            return tau
        shown = tau.copy()
        shown[self.elastic] -= self.rotors * a[self.elastic]
        return shown

    def advance(self, t: float, tau: np.ndarray, damping: np.ndarray, own: dict[int, np.ndarray]) -> np.ndarray:
        """One step under motor torques; acceleration on the side of the motors."""
        arm, dof, links = self.arm, self.dof, slice(0, self.dof)
        q, v = self.x[self.side], self.v_mid[self.side]
        felt, slope = tau.copy(), damping.copy()
        for number, pull in arm.pulls:
            before = felt.copy()
            pull.add(t, q, v, felt, slope)
            own[number] += before - felt
        force = np.zeros(self.x.size)
        bodies = arm.bodies_at(t)
        bias = bodies.bias(self.x[links], self.v_mid[links])
        force[links] = -bias
        force[self.side] += felt + slope * self.step / 2 * self.a[self.side]
        for e, (_, gear) in enumerate(arm.gears):
            j, m = gear.joint, dof + e
            push = gear.torque(self.x[m] - self.x[j], self.v_mid[m] - self.v_mid[j])
            force[j] += push
            force[m] -= push
        self.M[links, links] = bodies.inertia(self.x[links])
        A = self.M.copy()
        A[self.side, self.side] += arm.armature + slope * self.step / 2
        a = self._solve(t, q, A, force, own)
        self._move(a, bias)
        return a[self.side]

    def _solve(self, t: float, q: np.ndarray, A: np.ndarray, force: np.ndarray, own: dict) -> np.ndarray:
        if not self.arm.surfaces:
            return np.linalg.solve(A, force)
        inverse = np.linalg.inv(A)
        a = inverse @ force
        held = np.zeros(len(self.arm.surfaces))
        v_mid = self.v_mid[self.side]
        responses = [_response(inverse, self.side, surface) for _, surface in self.arm.surfaces]
        for _ in range(SWEEPS if held.size > 1 else 1):
            for s, (_, surface) in enumerate(self.arm.surfaces):
                answer, along = responses[s]
                w_next = sum(
                    weight * (self.v[self.side[j]] + self.step * a[self.side[j]]) for j, weight in surface.ways
                )
                stop = held[s] - w_next / (self.step * along)
                w = sum(weight * v_mid[j] for j, weight in surface.ways)
                level = surface.level(t, q, float(w), float(-stop), self.load)
                torque = min(max(float(stop), -level), level)
                a = a + answer * (torque - held[s])
                held[s] = torque
        for (number, surface), torque in zip(self.arm.surfaces, held, strict=True):
            for j, weight in surface.ways:
                own[number][j] -= weight * torque
        return a

    def _move(self, a: np.ndarray, bias: np.ndarray) -> None:
        links = slice(0, self.dof)
        carried = self.M[links, links] @ a[links] + bias
        self.load = carried
        self.v_mid_exact = self.v + self.step / 2 * a
        engine = self.arm.engine
        if engine is None:
            self.v = self.v + self.step * a
            self.x = self.x + self.step * self.v
        else:
            q, v = self.x[links], self.v[links]
            engine.push(carried + engine.bias(q, v) - engine.bias(q, self.v_mid[links]))
            self.v = self.v + self.step * a
            self.x = self.x + self.step * self.v
            self.x[links], self.v[links] = engine.state()
        self.a = a


def _response(inverse: np.ndarray, side: np.ndarray, surface: Surface) -> tuple[np.ndarray, float]:
    """Acceleration by a unit torque of a surface, and the part of it along the surface's own speed."""
    answer = np.sum([weight * inverse[:, side[j]] for j, weight in surface.ways], axis=0)
    return answer, float(sum(weight * answer[side[j]] for j, weight in surface.ways))
