"""Every effect that a diagnosis on motion knows, by its name in verdicts; a new one is a file and a line here."""

from __future__ import annotations

from lagnet.errors import EffectError, closest
from lagnet.servos.effect import ServoEffect
from lagnet.servos.effects.backlash import Backlash
from lagnet.servos.effects.command_delay import CommandDelay
from lagnet.servos.effects.coulomb_friction import CoulombFriction
from lagnet.servos.effects.dead_band import DeadBand
from lagnet.servos.effects.directional_load_friction import DirectionalLoadFriction
from lagnet.servos.effects.duty_saturation import DutySaturation
from lagnet.servos.effects.gain_error import GainError
from lagnet.servos.effects.gear_friction import GearFriction
from lagnet.servos.effects.joint_elasticity import JointElasticity
from lagnet.servos.effects.joint_spring import JointSpring
from lagnet.servos.effects.load_dependent_friction import LoadDependentFriction
from lagnet.servos.effects.load_error import LoadError
from lagnet.servos.effects.load_stribeck_friction import LoadStribeckFriction
from lagnet.servos.effects.position_bias import PositionBias
from lagnet.servos.effects.quadratic_drag import QuadraticDrag
from lagnet.servos.effects.quadratic_load_friction import QuadraticLoadFriction
from lagnet.servos.effects.rotor_inertia import RotorInertia
from lagnet.servos.effects.static_friction import StaticFriction
from lagnet.servos.effects.stribeck_friction import StribeckFriction
from lagnet.servos.effects.torque_offset import TorqueOffset
from lagnet.servos.effects.torque_saturation import TorqueSaturation
from lagnet.servos.effects.viscous_friction import ViscousFriction

_EFFECTS: tuple[ServoEffect, ...] = (
    GainError(),
    ViscousFriction(),
    CoulombFriction(),
    PositionBias(),
    CommandDelay(),
    RotorInertia(),
    LoadDependentFriction(),
    DirectionalLoadFriction(),
    QuadraticLoadFriction(),
    GearFriction(),
    StaticFriction(),
    StribeckFriction(),
    LoadStribeckFriction(),
    QuadraticDrag(),
    DeadBand(),
    DutySaturation(),
    TorqueSaturation(),
    TorqueOffset(),
    LoadError(),
    JointSpring(),
    JointElasticity(),
    Backlash(),
)
SERVO_CATALOGUE: dict[str, ServoEffect] = {effect.name: effect for effect in _EFFECTS}


def servo_effect(name: str) -> ServoEffect:
    """The effect of that name.

    Raises:
        EffectError: the catalogue has no such name.
    """
    if name in SERVO_CATALOGUE:
        return SERVO_CATALOGUE[name]
    near = closest(name, SERVO_CATALOGUE)
    raise EffectError(
        f"unknown servo effect {name!r}", choices=SERVO_CATALOGUE, next_step=f"did you mean {near}?" if near else None
    )
