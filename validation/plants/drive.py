"""What sits between motor and link in the true arm: stick-slip friction, drag, springs, reflected rotor inertia.

Friction sticks for good: an implicit step asks for the torque that stops the joint and grants it up to the level
that the surface can hold. There is no tanh(v/ε) anywhere.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class DrySurface:
    """Dry friction of one joint: kinetic levels in both directions and a static excess that fades with speed.

    Args:
        joint: index.
        forward, backward: kinetic level for v > 0 and v < 0 [N m].
        excess: what the level is higher by at rest [N m].
        fade: speed scale of the fading [rad/s].
        exponent: shape of the fading, exp(-|v/fade|^exponent).
    """

    joint: int
    forward: float
    backward: float
    excess: float = 0.0
    fade: float = 1.0
    exponent: float = 2.0

    def level(self, speed: float, side: float) -> float:
        """Friction torque that the surface can hold at a speed, towards one side [N m]."""
        kinetic = self.forward if side > 0 else self.backward
        return kinetic + self.excess * float(np.exp(-(abs(speed / self.fade) ** self.exponent)))


@dataclass(frozen=True)
class Drive:
    """All joint-side physics of a plant; arrays have shape (dof,)."""

    damping: np.ndarray  # [N m s/rad]
    drag: np.ndarray  # [N m s²/rad²]
    armature: np.ndarray  # [kg m²]
    stiffness: np.ndarray  # [N m/rad]
    rest: np.ndarray  # [rad]
    surfaces: tuple[DrySurface, ...] = ()

    @classmethod
    def ideal(cls, n_dof: int) -> Drive:
        """A drive that adds nothing."""
        return cls(*(np.zeros(n_dof) for _ in range(5)))

    @property
    def empty(self) -> bool:
        """Whether the links feel the motor torque alone."""
        smooth = (self.damping, self.drag, self.armature, self.stiffness)
        return not self.surfaces and not any(x.any() for x in smooth)

    def transmit(
        self,
        tau: np.ndarray,
        q: np.ndarray,
        v: np.ndarray,
        v_mid: np.ndarray,
        M: np.ndarray,
        h: np.ndarray,
        step: float,
    ) -> tuple[np.ndarray, np.ndarray]:
        """Torque on the links, and the joint acceleration of the step, for a motor torque.

        Args:
            tau: shape (dof,), motor torque [N m].
            q: shape (dof,), positions [rad].
            v: shape (dof,), speeds half a step before q [rad/s].
            v_mid: shape (dof,), speeds extrapolated to the instant of q [rad/s].
            M: shape (dof, dof), inertia of the bodies [kg m²].
            h: shape (dof,), gravity and velocity torque of the bodies at v_mid [N m].
            step: [s].
        """
        slope = self.damping + 2 * self.drag * np.abs(v_mid)  # linearly implicit: stable on light wrists
        smooth = -self.stiffness * (q - self.rest) - self.damping * v_mid - self.drag * v_mid * np.abs(v_mid)
        inverse = np.linalg.inv(M + np.diag(self.armature + slope * step / 2))
        smooth = smooth + slope * (v_mid - v)
        v_new = v + step * (inverse @ (tau + smooth - h))
        dry = self._dry(v_new, v_mid, inverse, step)
        a = (v_new - v) / step
        smooth = smooth - slope * step / 2 * a
        return tau + smooth + dry - self.armature * a, a

    def _dry(self, v_new: np.ndarray, v_mid: np.ndarray, inverse: np.ndarray, step: float) -> np.ndarray:
        """Stick-slip torques by sweeps over the surfaces; `v_new` is carried along in place."""
        held = np.zeros(v_new.size)
        for _ in range(1 if len(self.surfaces) < 2 else 6):
            for surface in self.surfaces:
                j = surface.joint
                ease = step * inverse[j, j]
                stop = held[j] - v_new[j] / ease  # the torque that would leave the joint at rest
                level = surface.level(v_mid[j], -stop)
                torque = float(np.clip(stop, -level, level))
                v_new += step * inverse[:, j] * (torque - held[j])
                held[j] = torque
        return held
