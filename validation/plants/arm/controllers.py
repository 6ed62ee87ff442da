"""Joint controllers that believe in the nominal bodies: computed torque, PD with gravity, PD with an integral."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from validation.plants.arm.bodies import PinocchioBodies
from validation.plants.motions import Reference


@dataclass(frozen=True, eq=False)
class Controller:
    """A law of torque, and how steeply it falls with speed.

    Args:
        torque: of step number, q, v; shape (dof,) [N m].
        damping: shape (dof,) [N m s/rad], which the loop solves for within its step: an analog speed loop.
    """

    torque: Callable[[int, np.ndarray, np.ndarray], np.ndarray]
    damping: np.ndarray


def computed_torque(bodies: PinocchioBodies, wanted: Reference, omega: np.ndarray, step: float) -> Controller:
    """Inverse dynamics of the wanted acceleration and a critically damped pull."""

    def torque(k: int, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        pull = omega**2 * (wanted.q[k] - q) + 2 * omega * (wanted.v[k] - v)
        return bodies.inertia(q) @ (wanted.a[k] + pull) + bodies.bias(q, v)

    return Controller(torque, np.zeros_like(omega))


LIGHTEST = 0.02  # of the arm's largest inertia: a wrist's drive is made for tools too


def _gains(bodies: PinocchioBodies, wanted: Reference, omega: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    few = wanted.q[:: max(1, wanted.q.shape[0] // 50)]
    inertia = np.mean([np.diag(bodies.inertia(q)) for q in few], axis=0)
    inertia = np.maximum(inertia, LIGHTEST * inertia.max())
    return inertia * omega**2, 2 * inertia * omega


def pd_with_gravity(bodies: PinocchioBodies, wanted: Reference, omega: np.ndarray, step: float) -> Controller:
    """Spring and damper to the wanted motion, weight compensated."""
    stiffness, damping = _gains(bodies, wanted, omega)

    def torque(k: int, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        return stiffness * (wanted.q[k] - q) + damping * (wanted.v[k] - v) + bodies.gravity(q)

    return Controller(torque, damping)


def pd_with_integral(bodies: PinocchioBodies, wanted: Reference, omega: np.ndarray, step: float) -> Controller:
    """Spring, damper and an integral that learns the weight; it starts at the weight of the first pose."""
    stiffness, damping = _gains(bodies, wanted, omega)
    rate = stiffness * omega / 5 * step
    total = bodies.gravity(wanted.q[0]).copy()

    def torque(k: int, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        error = wanted.q[k] - q
        np.add(total, rate * error, out=total)
        return stiffness * error + damping * (wanted.v[k] - v) + total

    return Controller(torque, damping)


CONTROLLERS = {
    "computed_torque": computed_torque,
    "pd_with_gravity": pd_with_gravity,
    "pd_with_integral": pd_with_integral,
}
