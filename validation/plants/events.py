"""What happens for a while only: a hand that pushes, a wall that gives way, a load that is picked up and put down.

PyBullet carries it: a push and a wall are external forces on the last arm link, a picked-up load is a body with another
last link that takes the motion over. Nothing here comes from lagnet.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pybullet

from validation.plants.body import Body, BodySettings, Payload, arm_joints
from validation.plants.spec import Hidden

SOFT = 0.05  # [m] over which the hand that pushes and the wall are not harder than they are elsewhere


@dataclass(frozen=True)
class Push:
    """A constant force in the axes of the base, on a point of the last arm link.

    Args:
        start, end: [s].
        force: in the axes of the base [N].
        point: in the frame of the last arm link [m].
    """

    start: float
    end: float
    force: tuple[float, float, float]
    point: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def at(self, place: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """Force on the point [N], wherever it is."""
        return np.asarray(self.force)


@dataclass(frozen=True)
class Wall:
    """A compliant wall that stands in the way for a while: a spring and a damper along its normal, no friction.

    Args:
        start, end: [s] between which it stands there.
        normal: towards the free side, unit vector in the axes of the base.
        face: distance of its face from the base along the normal [m].
        stiffness: [N/m]; damping: [N s/m].
        point: of the last arm link that touches it, in the link's frame [m].
    """

    start: float
    end: float
    normal: tuple[float, float, float]
    face: float
    stiffness: float = 400.0
    damping: float = 10.0
    point: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def at(self, place: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """Force on the point [N]: none off the wall, and a wall never pulls."""
        normal = np.asarray(self.normal)
        depth = self.face - float(normal @ place)
        if depth <= 0.0:
            return np.zeros(3)
        return normal * max(0.0, self.stiffness * min(depth, SOFT) - self.damping * float(normal @ speed))


@dataclass(frozen=True)
class Grasp:
    """A load that the last arm link carries for a while, picked up and put down without a jolt."""

    start: float
    end: float
    load: Payload


Event = Push | Wall | Grasp


def event_of(hidden: Hidden) -> Event | None:
    """What the plant does for a hidden entry that lasts for a while only; None for lasting physics."""
    x = hidden.values
    if "t0" not in x:
        return None
    if hidden.effect == "payload":
        return Grasp(x["t0"], x["t1"], Payload(x["m"], (x["cx"], x["cy"], x["cz"]), x["radius"]))
    force = (-x["Fx"], -x["Fy"], -x["Fz"])  # the catalogue names what the arm does to its surroundings
    return Push(x["t0"], x["t1"], force, (x["px"], x["py"], x["pz"]))


class EventfulBody:
    """A body to which things happen; it answers the calls of `Body`.

    Args:
        robot: name.
        settings: what the body always has.
        step: [s].
        events: what happens to it, by its own clock, which starts at zero.
    """

    def __init__(self, robot: str, settings: BodySettings, step: float, events: Sequence[Event]) -> None:
        self.step, self._steps = step, 0
        self._free = self._now = Body(robot, settings, step)
        self._touches = [e for e in events if not isinstance(e, Grasp)]
        grasps = [e for e in events if isinstance(e, Grasp)]
        self._laden = [(e, Body(robot, replace(settings, payload=e.load), step)) for e in grasps]
        self._link = self._free.link_of(arm_joints(robot)[-1])

    def put(self, q: np.ndarray, v: np.ndarray) -> None:
        """Set the state without physics."""
        self._now.put(q, v)

    def state(self) -> tuple[np.ndarray, np.ndarray]:
        """Positions at the instant, velocities half a step before it."""
        return self._now.state()

    def inertia(self, q: np.ndarray) -> np.ndarray:
        """Joint-space inertia with what is carried now, shape (dof, dof)."""
        return self._now.inertia(q)

    def bias(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Gravity and velocity torque, less the torque of what touches the arm now [N m]."""
        h = self._now.bias(q, v)
        for touch in self._acting():
            force, J, _ = self._contact(touch, q, v)
            h = h - J.T @ force
        return h

    def push(self, torque: np.ndarray) -> None:
        """One step of forward dynamics under joint torques and what touches the arm."""
        q, v = self._now.state()
        for touch in self._acting():
            force, _, place = self._contact(touch, q, v)
            pybullet.applyExternalForce(
                self._now.id, self._link, force, place, pybullet.WORLD_FRAME, physicsClientId=self._now.client
            )
        self._now.push(torque)
        self._steps += 1
        self._hand_over()

    def close(self) -> None:
        """Give the worlds back."""
        for body in (self._free, *(b for _, b in self._laden)):
            body.close()

    def _clock(self) -> float:
        return self._steps * self.step

    def _acting(self) -> list[Push | Wall]:
        return [e for e in self._touches if e.start <= self._clock() < e.end]

    def _hand_over(self) -> None:
        holding = [b for e, b in self._laden if e.start <= self._clock() < e.end]
        body = holding[0] if holding else self._free
        if body is not self._now:
            body.put(*self._now.state())
            self._now = body

    def _contact(self, touch: Push | Wall, q: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray, list[float]]:
        place, J = self._now.point(self._link, np.asarray(touch.point), q)
        return touch.at(place, J @ v), J, place.tolist()
