"""What a servo-driven model says of an arm that a simulator moves by position commands.

M a + h(q, v) + (rotor, friction, spring)/g = (motor + offset)/g: where a joint feels g times its nominal load, all else
of its law is divided by g, and the bodies stay as they are. What simulators know of a joint (damping, dry friction,
rotor, spring, yielding transmission) stands in an `ArmPhysics`; the whole law beside it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lagnet.errors import ModelError
from lagnet.models.corrected.servo_driven import ServoDrivenModel
from lagnet.rigid_body.robot import Robot
from lagnet.rollout.surface import BODY, HEIGHT, PX
from lagnet.servos.parameters import (
    BACK_EMF,
    COULOMB,
    DEAD_BAND,
    DRIVEN,
    DRIVING,
    ENCODER_SIDE,
    FULL_ERROR,
    GAP,
    INDEX,
    KD,
    KI,
    KP,
    LIMIT,
    LOAD_GAIN,
    LOAD_MOTOR,
    LOAD_SQUARED,
    NO_LIMIT,
    OFFSET,
    QUADRATIC,
    ROTOR,
    SATURATION,
    SPRING,
    SPRING_REST,
    STATIC,
    STIFFNESS,
    STRIBECK_SPEED,
    TWIST_DAMPING,
    VISCOUS,
)
from lagnet.simulators.corrected_arm.arm_physics import ArmPhysics, StribeckTerm, arm_physics

AT_ONCE = 1e-3  # [rad/s] over which friction falls that falls at once
TORQUES = (
    *(KP, KD, KI, LIMIT, ROTOR, VISCOUS, QUADRATIC, COULOMB, STATIC, OFFSET),
    *(STIFFNESS, BACK_EMF, SPRING, TWIST_DAMPING),
)  # in proportion to the torque's unit
PER_TORQUE = (LOAD_SQUARED, SATURATION)  # in proportion to its inverse
SCRIPTED_DRIVE = (DEAD_BAND, KI, SATURATION)  # no position actuator states them


@dataclass(frozen=True, eq=False)
class ServoArm:
    """An arm driven by position commands.

    Args:
        arm: bodies and joints, as far as laws of torque state them.
        laws: shape (dof, len(LAW)), whole laws at nominal loads (load_gain 1).
        surface: shape (len(SURFACE),), what the arm may rest on; None: nothing.
        voltage: nominal supply [V], 0 where none was recorded.
        touch: shape (dof,), share of a surface's force that each joint feels at its nominal load.
    """

    arm: ArmPhysics
    laws: np.ndarray
    surface: np.ndarray | None
    voltage: float
    touch: np.ndarray

    @property
    def torque_limit(self) -> np.ndarray:
        """Greatest torque of each controller, by its own limit and by full duty, infinite without one, shape (dof,)."""
        limit = self.laws[:, LIMIT].copy()
        full = np.where(self.laws[:, FULL_ERROR] < NO_LIMIT, self.laws[:, KP] * self.laws[:, FULL_ERROR], np.inf)
        limit[limit >= 0.5 * NO_LIMIT] = np.inf
        lost = 1.0 + self.laws[:, SATURATION] * np.where(np.isfinite(full), full, 0.0)
        return np.minimum(limit, full / lost)

    @property
    def scripted_drive(self) -> np.ndarray:
        """Whether a joint's controller is more than a position actuator, shape (dof,)."""
        yields = (self.laws[:, STIFFNESS] > 0.0) | (self.laws[:, GAP] > 0.0)
        more = np.any(self.laws[:, SCRIPTED_DRIVE] != 0.0, axis=1)
        return more | (yields & (self.laws[:, ENCODER_SIDE] > 0.5))

    @property
    def scripted_friction(self) -> np.ndarray:
        """Whether a joint's dry friction changes with speed, load or motor, shape (dof,)."""
        changing = (STATIC, DRIVING, DRIVEN, LOAD_SQUARED, LOAD_MOTOR)
        return np.any(self.laws[:, changing] != 0.0, axis=1)


def servo_arm(model: ServoDrivenModel) -> ServoArm:
    """The forward physics of a servo-driven model.

    Raises:
        ModelError: its loads are zero at a joint, or it has no bodies.
    """
    if not isinstance(model.nominal, Robot):
        raise ModelError("has no bodies to export", next_step="diagnose against a URDF or MJCF")
    laws = at_nominal_load(model.laws)
    arm = arm_physics(model.nominal)
    arm = replace(
        arm,
        rotor=laws[:, ROTOR],
        viscous=laws[:, VISCOUS] + laws[:, BACK_EMF],
        quadratic=laws[:, QUADRATIC],
        forward=laws[:, COULOMB],
        backward=laws[:, COULOMB],
        load_friction=0.5 * (laws[:, DRIVING] + laws[:, DRIVEN]) + laws[:, LOAD_MOTOR],
        stiffness=laws[:, SPRING],
        spring_rest=laws[:, SPRING_REST],
        elasticity=np.where(laws[:, STIFFNESS] > 0.0, laws[:, STIFFNESS], np.inf),
        twist_damping=laws[:, TWIST_DAMPING],
        half_gap=laws[:, GAP],
        stribeck=tuple(
            StribeckTerm(j, float(law[STATIC]), max(float(law[STRIBECK_SPEED]), AT_ONCE))
            for j, law in enumerate(laws)
            if law[STATIC] > 0.0
        ),
    )
    rigid = (laws[:, STIFFNESS] == 0.0) & (laws[:, GAP] == 0.0)  # others feel no surface
    limited = ServoArm(arm, laws, model.surface, model.voltage, rigid / model.laws[:, LOAD_GAIN])
    drives = tuple(d.clipped(most) for d, most in zip(arm.drives, limited.torque_limit.tolist(), strict=True))
    return replace(limited, arm=replace(arm, drives=drives))


def at_nominal_load(laws: np.ndarray) -> np.ndarray:
    """The same motion with a load gain of 1, shape (dof, len(LAW)).

    Raises:
        ModelError: a load gain of zero.
    """
    gain = laws[:, LOAD_GAIN]
    if not np.all(gain > 0.0):
        raise ModelError("feels no load at a joint, which no simulator's bodies do", next_step="diagnose again")
    out = laws.copy()
    out[:, TORQUES] /= gain[:, None]
    out[:, PER_TORQUE] *= gain[:, None]
    out[:, LOAD_GAIN] = 1.0
    unlimited = laws[:, LIMIT] >= NO_LIMIT
    out[unlimited, LIMIT] = NO_LIMIT
    return out


def settings_of_servos(arm: ServoArm) -> dict:
    """The laws by parameter, as plain data for the scripts beside a model."""
    return {
        "law": {name: [float(x) for x in arm.laws[:, i]] for name, i in INDEX.items()},
        "scripted_drive": [bool(x) for x in arm.scripted_drive],
        "scripted_friction": [bool(x) for x in arm.scripted_friction],
        "voltage": arm.voltage,
        "surface": None if arm.surface is None else _surface(arm.surface, arm.touch),
    }


def _surface(surface: np.ndarray, touch: np.ndarray) -> dict:
    """What a joint's link touches, and where, as plain data."""
    height, hardness, friction = map(float, surface[HEIGHT:])
    out = {"joint": int(surface[BODY]), "point": surface[PX:HEIGHT].tolist(), "share": touch.tolist()}
    return out | {"height": height, "hardness": hardness, "friction": friction}
