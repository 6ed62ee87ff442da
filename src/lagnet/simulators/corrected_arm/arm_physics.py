"""What a corrected model says of an arm that moves forward: its effects as the numbers that a simulator needs.

The catalogue states effects as torques that are added to a nominal model along a recorded motion. A simulator wants the
other direction: what passes between the command and the joint, what acts at the joint, and what the bodies are.
Friction is taken as what the regression blurs: s(v) becomes a set-valued sign, so that a joint at rest sticks.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np

from lagnet.effects.catalogue import effect_named
from lagnet.effects.torque.load_dependent_friction import LoadDependentFriction
from lagnet.errors import ModelError
from lagnet.models.corrected.changed_bodies import apply_to_bodies
from lagnet.models.corrected.identified import IdentifiedLayer
from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.rigid_body.robot import Robot
from lagnet.simulators.corrected_arm.drive import Drive
from lagnet.simulators.corrected_arm.identified_parts import IdentifiedPart, changed_robot, term_part
from lagnet.types import JointVector

IN_BODIES = ("payload", "link_inertia", "gravity_tilt")


@dataclass(frozen=True)
class StribeckTerm:
    """Extra dry friction Fs exp(−(v/vs)²) near standstill at one joint [N m, rad/s]."""

    joint: int
    extra: float
    speed: float


@dataclass(frozen=True)
class RippleTerm:
    """Torque A sin(N q + φ) that the motor has to add at one joint [N m, 1/rad, rad]."""

    joint: int
    order: float
    amplitude: float
    phase: float


@dataclass(frozen=True)
class CouplingTerm:
    """A motor that turns with w = v_j + c v_(j−1): its viscous and dry friction and its rotor."""

    joint: int
    viscous: float
    dry: float
    rotor: float
    ratio: float


@dataclass(frozen=True)
class BristleTerm:
    """Dahl friction σ0 z with ż = v − |v| σ0 z / Fc at one joint [N m/rad, N m]."""

    joint: int
    stiffness: float
    friction: float


@dataclass(frozen=True, eq=False)
class ArmPhysics:
    """An arm with everything that was named, ready to be moved forward or written down.

    Args:
        robot: the bodies with payload, changed links and the direction of gravity; without rotors.
        shift: shape (dof,), true position less the one that the encoder gives [rad].
        rotor: shape (dof,), inertia felt at the joint, those of the nominal model among them [kg m²].
        viscous, quadratic: shape (dof,), torque per speed and per squared speed.
        forward, backward: shape (dof,), dry friction against motion in the positive and negative direction [N m].
        load_friction: shape (dof,), dry friction per torque carried.
        load_friction_by_power: shape (dof,), how much more of it there is while the motor drives the load, and less
            while the load drives the motor.
        stiffness, spring_rest: shape (dof,), spring towards a position [N m/rad, rad].
        elasticity: shape (dof,), stiffness between motor and link, infinite where they are one [N m/rad].
        twist_damping: shape (dof,), damping between motor and link [N m s/rad].
        half_gap: shape (dof,), half the play between motor and link [rad].
        stribeck, ripples, couplings, bristles: terms at single joints.
        drives: what lies between a commanded torque and the joint, one for each joint.
        blur: shape (dof,), speed within which the recordings did not tell the sign of the motion [rad/s].
        transient: effects that belong to an interval or to one recording, and so to no simulator.
        identified: parts of identified layers; those that act like a named effect are in the numbers above.
    """

    robot: Robot
    shift: JointVector
    rotor: JointVector
    viscous: JointVector
    quadratic: JointVector
    forward: JointVector
    backward: JointVector
    load_friction: JointVector
    load_friction_by_power: JointVector
    stiffness: JointVector
    spring_rest: JointVector
    elasticity: JointVector
    twist_damping: JointVector
    half_gap: JointVector
    stribeck: tuple[StribeckTerm, ...]
    ripples: tuple[RippleTerm, ...]
    couplings: tuple[CouplingTerm, ...]
    bristles: tuple[BristleTerm, ...]
    drives: tuple[Drive, ...]
    blur: JointVector
    transient: tuple[NamedEffect, ...] = ()
    identified: tuple[IdentifiedPart, ...] = ()

    @property
    def n_dof(self) -> int:
        """Number of joints."""
        return self.robot.n_dof

    @property
    def mean_friction(self) -> JointVector:
        """Dry friction, mean of both directions, shape (dof,) [N m]."""
        return (self.forward + self.backward) / 2.0

    @property
    def friction_bias(self) -> JointVector:
        """Half the difference of dry friction between the directions, which acts like a constant, shape (dof,)."""
        return (self.forward - self.backward) / 2.0

    @property
    def compliant(self) -> np.ndarray:
        """Whether motor and link are two at a joint, shape (dof,)."""
        return np.isfinite(self.elasticity) | (self.half_gap > 0.0)

    def rotor_matrix(self) -> np.ndarray:
        """Inertia of rotors in the coordinates of the joints, shape (dof, dof) [kg m²]."""
        matrix = np.diag(self.rotor)
        for term in self.couplings:
            row = self.coupling_row(term)
            matrix = matrix + term.rotor * np.outer(row, row)
        return matrix

    def coupling_row(self, term: CouplingTerm) -> np.ndarray:
        """Speed of a coupled motor per unit of each joint's speed, shape (dof,)."""
        row = np.zeros(self.n_dof)
        row[term.joint], row[term.joint - 1] = 1.0, term.ratio
        return row


def arm_physics(model: Robot | CorrectedModel) -> ArmPhysics:
    """The forward physics of a robot or a corrected model.

    Raises:
        ModelError: the model has no bodies, so that no simulator can hold it.
        RobotError: a joint has nothing with mass behind it, corrections counted.
    """
    nominal, effects, blur = _flattened(model)
    if not isinstance(nominal, Robot):
        raise ModelError(
            f"a model of kind {getattr(nominal, 'kind', type(nominal).__name__)} has no bodies to export",
            next_step="diagnose against a URDF or MJCF, or export a model with bodies",
        )
    persistent = [
        e for e in effects if e.interval is None and e.recording is None and not effect_named(e.effect).is_transient
    ]
    transient = tuple(e for e in effects if e not in persistent)
    armature = np.array(nominal.armature)
    bodies = cast(Robot, apply_to_bodies(nominal, [e for e in persistent if e.effect in IN_BODIES]))
    arm = _bare(bodies.with_armature(np.zeros(bodies.n_dof)), armature, blur, transient)
    for effect in persistent:
        if effect.effect not in IN_BODIES:
            arm = ADDED[effect.effect](arm, effect.joint, effect.values)
    for layer in _identified_layers(model):
        arm = _with_identified(arm, layer)
    arm.robot.require_mass()
    return arm


def _identified_layers(model: Any) -> list[IdentifiedLayer]:
    """Those of a corrected model and of the corrected models that it stands on."""
    if not isinstance(model, CorrectedModel):
        return []
    return [*_identified_layers(model.nominal), *([] if model.identified is None else [model.identified])]


def _with_identified(arm: ArmPhysics, layer: IdentifiedLayer) -> ArmPhysics:
    robot, parts = changed_robot(arm.robot, layer)
    arm = replace(arm, robot=robot)
    pairs = [(t, w) for t, w in zip(layer.terms, layer.weights.tolist(), strict=True) if w != 0.0]
    for term, weight in sorted(pairs, key=lambda pair: pair[0].kind != "gain"):  # what else is weighted is of this log
        felt = weight if term.kind == "offset" else weight / arm.drives[term.joint].gain
        part = term_part(term, felt, _least_weight(arm, term.kind, term.joint))
        parts.append(part)
        if part.alike is not None:
            added = _scaled_bodies if term.kind == "gain" else ADDED[part.alike.effect]
            arm = added(arm, term.joint, part.alike.values)
    return replace(arm, identified=(*arm.identified, *parts))


def _least_weight(arm: ArmPhysics, kind: str, joint: int) -> float:
    """The weight with which what a joint has of a kind becomes zero."""
    has = {
        "viscous": arm.viscous[joint],
        "dry": min(arm.forward[joint], arm.backward[joint]),
        "rotor": arm.rotor[joint],
        "load": arm.load_friction[joint],
        "spring": arm.stiffness[joint],
        "gain": 1.0,
    }
    return -float(has[kind]) if kind in has else -np.inf


def _flattened(model: Any) -> tuple[Any, list[NamedEffect], JointVector | None]:
    """Nominal model, effects of all layers, blur."""
    if not isinstance(model, CorrectedModel):
        return model, [], None
    nominal, effects, _ = _flattened(model.nominal)
    return nominal, [*effects, *model.effects], model.slow


def _bare(robot: Robot, rotor: JointVector, blur: JointVector | None, transient: tuple[NamedEffect, ...]) -> ArmPhysics:
    n = robot.n_dof
    zero = [np.zeros(n) for _ in range(11)]
    rigid = np.full(n, np.inf)
    drives = tuple(Drive() for _ in range(n))
    blurred = np.zeros(n) if blur is None else np.asarray(blur, dtype=float)
    shift, viscous, quadratic, forward, backward, load, power, stiffness, rest, damping, gap = zero
    fields = (shift, rotor, viscous, quadratic, forward, backward, load, power, stiffness, rest, rigid, damping, gap)
    return ArmPhysics(robot, *fields, (), (), (), (), drives, blurred, transient)


def _plus(vector: np.ndarray, joint: int | None, value: float) -> np.ndarray:
    assert joint is not None
    out = vector.copy()
    out[joint] += value
    return out


def _viscous(arm: ArmPhysics, joint: int, v: Any) -> ArmPhysics:
    return replace(arm, viscous=_plus(arm.viscous, joint, v["Fv"]))


def _quadratic(arm: ArmPhysics, joint: int, v: Any) -> ArmPhysics:
    return replace(arm, quadratic=_plus(arm.quadratic, joint, v["Fd"]))


def _dry(arm: ArmPhysics, joint: int, forward: float, backward: float) -> ArmPhysics:
    return replace(arm, forward=_plus(arm.forward, joint, forward), backward=_plus(arm.backward, joint, backward))


def _per_load(arm: ArmPhysics, joint: int, v: Any) -> ArmPhysics:
    """K, or on the motor's side K / (1 − K) where the motor drives and K / (1 + K) where the load does."""
    driving, driven = LoadDependentFriction.by_power(v)
    arm = replace(arm, load_friction=_plus(arm.load_friction, joint, 0.5 * (driving + driven)))
    by_power = _plus(arm.load_friction_by_power, joint, 0.5 * (driving - driven))
    return replace(arm, load_friction_by_power=by_power)


def _stribeck(arm: ArmPhysics, joint: int, v: Any) -> ArmPhysics:
    arm = _dry(arm, joint, v["Fc"], v["Fc"])
    return replace(arm, stribeck=(*arm.stribeck, StribeckTerm(joint, v["Fs"], v["vs"])))


def _spring(arm: ArmPhysics, joint: int, v: Any) -> ArmPhysics:
    """Springs side by side are one: k = Σ k_i about Σ k_i q_i / Σ k_i."""
    stiffness = _plus(arm.stiffness, joint, v["k"])
    pull = arm.stiffness[joint] * arm.spring_rest[joint] + v["k"] * v["q0"]
    rest = arm.spring_rest.copy()
    rest[joint] = pull / stiffness[joint] if stiffness[joint] else 0.0
    return replace(arm, stiffness=stiffness, spring_rest=rest)


def _ripple(arm: ArmPhysics, joint: int, v: Any) -> ArmPhysics:
    return replace(arm, ripples=(*arm.ripples, RippleTerm(joint, v["N"], v["amplitude"], v["phase"])))


def _coupling(arm: ArmPhysics, joint: int, v: Any) -> ArmPhysics:
    term = CouplingTerm(joint, v["Fv"], v["Fc"], v["Ia"], v["ratio"])
    return replace(arm, couplings=(*arm.couplings, term))


def _bristle(arm: ArmPhysics, joint: int, v: Any) -> ArmPhysics:
    return replace(arm, bristles=(*arm.bristles, BristleTerm(joint, v["sigma0"], v["Fc"])))


def _elastic(arm: ArmPhysics, joint: int, v: Any) -> ArmPhysics:
    """Springs in a row add their compliances."""
    stiffness = arm.elasticity.copy()
    stiffness[joint] = 1.0 / (1.0 / stiffness[joint] + 1.0 / v["K"])
    return replace(arm, elasticity=stiffness, twist_damping=_plus(arm.twist_damping, joint, v.get("D", 0.0)))


TORQUES: dict[str, tuple[str, ...]] = {
    "stribeck": ("extra",),
    "ripples": ("amplitude",),
    "couplings": ("viscous", "dry", "rotor"),
    "bristles": ("stiffness", "friction"),
}
"""What of the terms at single joints is a torque, or one per unit of motion."""


def _scaled_bodies(arm: ArmPhysics, joint: int, v: Any) -> ArmPhysics:
    """The log scaled as regards the bodies alone: friction and springs are less by as much, and logged as before."""
    share = np.where(np.arange(arm.n_dof) == joint, 1.0 / v["g"], 1.0)
    own = ("viscous", "quadratic", "forward", "backward", "load_friction", "load_friction_by_power", "stiffness")
    terms = {
        kind: tuple(replace(t, **{f: share[t.joint] * getattr(t, f) for f in fields}) for t in getattr(arm, kind))
        for kind, fields in TORQUES.items()
    }
    arm = replace(arm, **{field: share * getattr(arm, field) for field in own}, **terms)
    drive = arm.drives[joint]
    return _driven(arm, joint, replace(drive, gain=v["g"] * drive.gain))


def _driven(arm: ArmPhysics, joint: int, drive: Drive) -> ArmPhysics:
    return replace(arm, drives=tuple(drive if i == joint else d for i, d in enumerate(arm.drives)))


ADDED: dict[str, Any] = {
    "viscous_friction": _viscous,
    "quadratic_drag": _quadratic,
    "coulomb_friction": lambda arm, joint, v: _dry(arm, joint, v["Fc"], v["Fc"]),
    "asymmetric_friction": lambda arm, joint, v: _dry(arm, joint, v["Fc_plus"], v["Fc_minus"]),
    "stribeck_friction": _stribeck,
    "load_dependent_friction": _per_load,
    "rotor_inertia": lambda arm, joint, v: replace(arm, rotor=_plus(arm.rotor, joint, v["Ia"])),
    "joint_spring": _spring,
    "torque_ripple": _ripple,
    "coupled_transmission": _coupling,
    "presliding_hysteresis": _bristle,
    "joint_elasticity": _elastic,
    "backlash": lambda arm, joint, v: replace(arm, half_gap=_plus(arm.half_gap, joint, v["h"])),
    "encoder_offset": lambda arm, joint, v: replace(arm, shift=_plus(arm.shift, joint, v["delta"])),
    "torque_gain": lambda arm, joint, v: _driven(arm, joint, arm.drives[joint].scaled(v["g"])),
    "torque_offset": lambda arm, joint, v: _driven(arm, joint, arm.drives[joint].moved(v["b"])),
    "saturation": lambda arm, joint, v: _driven(arm, joint, arm.drives[joint].clipped(v["tau_max"])),
    "time_delay": lambda arm, joint, v: _driven(arm, joint, arm.drives[joint].later(v["T"])),
}


def without(model: CorrectedModel, effects: Iterable[NamedEffect]) -> CorrectedModel:
    """The same model less some effects: what a simulator shows that has no place for them."""
    gone = list(effects)
    return model.with_effects([e for e in model.effects if e not in gone])
