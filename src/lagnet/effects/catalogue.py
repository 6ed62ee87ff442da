"""Every effect that lagnet knows, by the name that stands in verdicts. A new effect is one file and one line here."""

from __future__ import annotations

from lagnet.effects.effect import Effect
from lagnet.effects.external.contact_force import ContactForce
from lagnet.effects.inertia.gravity_tilt import GravityTilt
from lagnet.effects.inertia.link_inertia import LinkInertia
from lagnet.effects.inertia.payload import Payload
from lagnet.effects.inertia.rotor_inertia import RotorInertia
from lagnet.effects.signal.encoder_offset import EncoderOffset
from lagnet.effects.signal.saturation import Saturation
from lagnet.effects.signal.time_delay import TimeDelay
from lagnet.effects.signal.torque_gain import TorqueGain
from lagnet.effects.signal.torque_offset import TorqueOffset
from lagnet.effects.state.backlash import Backlash
from lagnet.effects.state.joint_elasticity import JointElasticity
from lagnet.effects.state.presliding_hysteresis import PreslidingHysteresis
from lagnet.effects.torque.asymmetric_friction import AsymmetricFriction
from lagnet.effects.torque.coulomb_friction import CoulombFriction
from lagnet.effects.torque.coupled_transmission import CoupledTransmission
from lagnet.effects.torque.joint_spring import JointSpring
from lagnet.effects.torque.load_dependent_friction import LoadDependentFriction
from lagnet.effects.torque.quadratic_drag import QuadraticDrag
from lagnet.effects.torque.stribeck_friction import StribeckFriction
from lagnet.effects.torque.torque_ripple import TorqueRipple
from lagnet.effects.torque.viscous_friction import ViscousFriction
from lagnet.errors import EffectError, closest

_EFFECTS: tuple[Effect, ...] = (
    ViscousFriction(),
    CoulombFriction(),
    AsymmetricFriction(),
    StribeckFriction(),
    QuadraticDrag(),
    RotorInertia(),
    Payload(),
    LinkInertia(),
    GravityTilt(),
    JointSpring(),
    TorqueGain(),
    TorqueOffset(),
    TimeDelay(),
    LoadDependentFriction(),
    TorqueRipple(),
    EncoderOffset(),
    JointElasticity(),
    Backlash(),
    PreslidingHysteresis(),
    Saturation(),
    CoupledTransmission(),
    ContactForce(),
)

CATALOGUE: dict[str, Effect] = {effect.name: effect for effect in _EFFECTS}
"""Every effect by its name, in the order of the table in the README."""


def effect_named(name: str) -> Effect:
    """The effect of that name.

    Raises:
        EffectError: the catalogue has no such name.
    """
    if name in CATALOGUE:
        return CATALOGUE[name]
    near = closest(name, CATALOGUE)
    hint = f"did you mean {near}?" if near else None
    raise EffectError(f"unknown effect {name!r}", choices=CATALOGUE, next_step=hint)
