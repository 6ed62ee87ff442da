"""USD as text: UsdPhysics bodies and joints, with the attributes of PhysX and of Newton side by side.

Angles of UsdPhysics are in degrees, and so is what is counted per angle: viscous friction in N m s/deg, stiffness in
N m/deg.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import ClassVar, final

import numpy as np
from scipy.spatial.transform import Rotation

from lagnet.rigid_body.body_tree import TreeBody
from lagnet.rigid_body.descriptions.writing import write_text
from lagnet.simulators.corrected_arm.arm_physics import ArmPhysics
from lagnet.simulators.exporter import Exporter, Place, approximate, exact, nowhere
from lagnet.simulators.exporters.sdf import joint_friction, shifted_frame
from lagnet.simulators.xml_text import quaternion

PER_DEGREE = np.pi / 180.0
X = np.array([1.0, 0.0, 0.0])
SIGNAL = "USD states what a joint is, not what its command passes through"


@final
class UsdExporter(Exporter):
    """Universal Scene Description with physics."""

    name = "usd"
    title = "USD (PhysX, Newton)"
    reads = "UsdPhysics with PhysxJointAxisAPI (Isaac Sim ≥ 5) and NewtonJointAPI"
    places: ClassVar[Mapping[str, Place]] = {
        "viscous_friction": exact(
            "physxJointAxis:angular:viscousFrictionCoefficient, newton:damping", "per degree: N m s/deg"
        ),
        "coulomb_friction": exact(
            "physxJointAxis:angular:staticFrictionEffort, dynamicFrictionEffort, newton:friction"
        ),
        "asymmetric_friction": approximate("the same efforts, mean of both directions", "they have no direction"),
        "stribeck_friction": approximate(
            "staticFrictionEffort Fc + Fs, dynamicFrictionEffort Fc; newton:friction Fc + Fs",
            "PhysX falls from one to the other at once, not over v_s; Newton has one number",
        ),
        "quadratic_drag": nowhere("friction there is constant or linear in speed"),
        "rotor_inertia": exact("physxJointAxis:angular:armature, newton:armature"),
        "payload": exact("PhysicsMassAPI"),
        "link_inertia": exact("PhysicsMassAPI"),
        "gravity_tilt": exact("PhysicsScene gravityDirection"),
        "joint_spring": exact("PhysicsDriveAPI stiffness, targetPosition", "per degree; takes the place of a drive"),
        "torque_gain": nowhere(SIGNAL),
        "torque_offset": nowhere(SIGNAL),
        "time_delay": nowhere(SIGNAL),
        "load_dependent_friction": approximate(
            "the efforts of friction, those under the weight of the zero pose", "they do not follow the load"
        ),
        "torque_ripple": nowhere("no torque there depends on position as a wave"),
        "encoder_offset": exact("physics:localRot0"),
        "joint_elasticity": nowhere(
            "the motor's side would need a body of its own, which turns with the links before it"
        ),
        "backlash": nowhere("the motor's side would need a body of its own, which turns with the links before it"),
        "presliding_hysteresis": approximate(
            "the efforts of friction, that once sliding", "no bristles before sliding"
        ),
        "saturation": exact("PhysicsDriveAPI maxForce"),
        "coupled_transmission": nowhere("friction there acts on single joints"),
    }

    def write(self, arm: ArmPhysics, folder: Path) -> tuple[Path, ...]:
        path = folder / "model.usda"
        write_text(path, usd_of(arm))
        return (path,)


def usd_of(arm: ArmPhysics, gains: Sequence[tuple[float, float]] | None = None) -> str:
    """The arm as USD text; gains: kp and kd of a position drive at every joint [N m/rad, N m s/rad]."""
    tree = arm.robot.body_tree()
    names = prim_names([b.name for b in tree])
    placed = _placed(arm, tree)
    size = float(np.linalg.norm(arm.robot.gravity))
    direction = arm.robot.gravity / size
    lines = [
        "#usda 1.0",
        '(\n    defaultPrim = "World"\n    metersPerUnit = 1\n    kilogramsPerUnit = 1\n    upAxis = "Z"\n)',
        'def Xform "World"\n{',
        'def PhysicsScene "Scene"\n{',
        f"vector3f physics:gravityDirection = {_tuple(direction)}",
        f"float physics:gravityMagnitude = {size!r}",
        "}",
        'def Xform "Arm" (prepend apiSchemas = ["PhysicsArticulationRootAPI"])\n{',
        'def Xform "base" (prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI"])\n{',
        "float physics:mass = 1\n}",
        'def PhysicsFixedJoint "mounting"\n{\nrel physics:body1 = </World/Arm/base>\n}',
    ]
    for j, body in enumerate(tree):
        lines += _body(names[j], body, placed[j])
    friction = joint_friction(arm)
    for j, body in enumerate(tree):
        parent = "base" if body.parent < 0 else names[body.parent]
        lines += _joint(arm, j, body, (parent, names[j]), float(friction[j]), None if gains is None else gains[j])
    return "\n".join([*lines, "}", "}"]) + "\n"


def prim_names(names: Sequence[str]) -> list[str]:
    """Names that USD takes: letters, digits and underscores, each once."""
    out: list[str] = []
    for name in names:
        clean = re.sub(r"\W", "_", name, flags=re.ASCII)
        clean = f"_{clean}" if not clean or clean[0].isdigit() else clean
        while clean in (*out, "base", "mounting"):
            clean += "_"
        out.append(clean)
    return out


def _placed(arm: ArmPhysics, tree: tuple[TreeBody, ...]) -> list[tuple[np.ndarray, np.ndarray]]:
    """Position and axes of every body in the base, encoders at zero."""
    out: list[tuple[np.ndarray, np.ndarray]] = []
    for j, body in enumerate(tree):
        position, rotation = shifted_frame(body, float(arm.shift[j]))
        if body.parent >= 0:
            before, turned = out[body.parent]
            position, rotation = before + turned @ position, turned @ rotation
        out.append((position, rotation))
    return out


def _tuple(values: np.ndarray) -> str:
    return f"({', '.join(repr(float(v)) for v in values)})"


def _body(name: str, body: TreeBody, place: tuple[np.ndarray, np.ndarray]) -> list[str]:
    moments, axes = np.linalg.eigh(body.inertia)
    if np.linalg.det(axes) < 0.0:
        axes = axes * np.array([1.0, 1.0, -1.0])
    return [
        f'def Xform "{name}" (prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI"])\n{{',
        f"double3 xformOp:translate = {_tuple(place[0])}",
        f"quatd xformOp:orient = {_tuple(quaternion(place[1]))}",
        'uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:orient"]',
        f"float physics:mass = {body.mass!r}",
        f"point3f physics:centerOfMass = {_tuple(body.centre)}",
        f"float3 physics:diagonalInertia = {_tuple(moments)}",
        f"quatf physics:principalAxes = {_tuple(quaternion(axes))}",
        "}",
    ]


def _joint(
    arm: ArmPhysics,
    j: int,
    body: TreeBody,
    names: tuple[str, str],
    friction: float,
    gains: tuple[float, float] | None,
) -> list[str]:
    kind, axis = ("Revolute", "angular") if body.turns else ("Prismatic", "linear")
    unit = PER_DEGREE if body.turns else 1.0
    position, rotation = shifted_frame(body, float(arm.shift[j]))
    along = Rotation.align_vectors([body.axis], [X])[0].as_matrix()
    own = re.sub(r"\W", "_", body.joint, flags=re.ASCII)
    limits = [
        f"float physics:lowerLimit = {body.lower / unit!r}",
        f"float physics:upperLimit = {body.upper / unit!r}",
    ]
    drive, schemas = _drive(arm, j, axis, unit, gains)
    applied = f'"PhysxJointAxisAPI:{axis}", "NewtonJointAPI"{schemas}'
    return [
        f'def Physics{kind}Joint "joint_{own}" (prepend apiSchemas = [{applied}])\n{{',
        f"rel physics:body0 = </World/Arm/{names[0]}>\nrel physics:body1 = </World/Arm/{names[1]}>",
        'uniform token physics:axis = "X"',
        f"point3f physics:localPos0 = {_tuple(position)}\npoint3f physics:localPos1 = (0, 0, 0)",
        f"quatf physics:localRot0 = {_tuple(quaternion(rotation @ along))}",
        f"quatf physics:localRot1 = {_tuple(quaternion(along))}",
        *(limits if np.isfinite(body.lower) and np.isfinite(body.upper) else []),
        *_friction(arm, j, axis, unit, friction),
        *drive,
        "}",
    ]


def _friction(arm: ArmPhysics, j: int, axis: str, unit: float, friction: float) -> list[str]:
    extra = sum(t.extra for t in arm.stribeck if t.joint == j)
    values = {
        f"physxJointAxis:{axis}:armature": arm.rotor[j],
        f"physxJointAxis:{axis}:staticFrictionEffort": friction,
        f"physxJointAxis:{axis}:dynamicFrictionEffort": friction - extra,
        f"physxJointAxis:{axis}:viscousFrictionCoefficient": arm.viscous[j] * unit,
        "newton:armature": arm.rotor[j],
        "newton:friction": friction,
        "newton:damping": arm.viscous[j] * unit,
    }
    return [f"float {key} = {float(value)!r}" for key, value in values.items()]


def _drive(arm: ArmPhysics, j: int, axis: str, unit: float, gains: tuple[float, float] | None) -> tuple[list[str], str]:
    """Servo or spring, and limit of force, and the schema that holds them."""
    lines, limit = [], arm.drives[j].most
    if gains is not None:
        lines += [
            f"float drive:{axis}:physics:stiffness = {float(gains[0] * unit)!r}",
            f"float drive:{axis}:physics:damping = {float(gains[1] * unit)!r}",
        ]
    elif arm.stiffness[j]:
        lines += [
            f"float drive:{axis}:physics:stiffness = {float(arm.stiffness[j] * unit)!r}",
            f"float drive:{axis}:physics:targetPosition = {float(arm.spring_rest[j] / unit)!r}",
        ]
    if np.isfinite(limit):
        lines.append(f"float drive:{axis}:physics:maxForce = {float(limit)!r}")
    return lines, f', "PhysicsDriveAPI:{axis}"' if lines else ""
