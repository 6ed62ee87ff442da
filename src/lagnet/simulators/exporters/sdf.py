"""SDF: bodies and joints with damping, friction and springs, for Gazebo and other readers of SDFormat."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import ClassVar, final
from xml.etree.ElementTree import Element, SubElement

import numpy as np
from scipy.spatial.transform import Rotation

from lagnet.rigid_body.body_tree import TreeBody
from lagnet.simulators.corrected_arm.arm_physics import ArmPhysics
from lagnet.simulators.exporter import Exporter, Place, approximate, exact, nowhere
from lagnet.simulators.exporters.mjcf import friction_at_rest
from lagnet.simulators.xml_text import number, numbers, roll_pitch_yaw, write_xml

SIGNAL = "SDF has no actuator whose torque could be scaled, moved or delayed"
DOWN = np.array([0.0, 0.0, -1.0])


@final
class SdfExporter(Exporter):
    """Simulation Description Format."""

    name = "sdf"
    title = "SDF (Gazebo)"
    reads = "SDFormat ≥ 1.9: Gazebo, Drake"
    places: ClassVar[Mapping[str, Place]] = {
        "viscous_friction": exact("axis/dynamics/damping"),
        "coulomb_friction": exact("axis/dynamics/friction", "Gazebo's DART applies it; Drake ignores it"),
        "asymmetric_friction": approximate("axis/dynamics/friction, mean of both directions", "SDF has one for both"),
        "stribeck_friction": approximate("axis/dynamics/friction, that near standstill", "it does not fall with speed"),
        "quadratic_drag": nowhere("damping of SDF is linear in speed"),
        "rotor_inertia": nowhere("SDF has no rotors; on the link it would turn with the joints before it too"),
        "payload": exact("link/inertial"),
        "link_inertia": exact("link/inertial"),
        "gravity_tilt": exact(
            "model/pose", "the model stands as the arm does, in a world whose gravity points along −z"
        ),
        "joint_spring": exact("axis/dynamics/spring_stiffness, spring_reference"),
        "torque_gain": nowhere(SIGNAL),
        "torque_offset": nowhere(SIGNAL),
        "time_delay": nowhere(SIGNAL),
        "load_dependent_friction": approximate(
            "axis/dynamics/friction, that under the weight of the zero pose", "it does not follow the load"
        ),
        "torque_ripple": nowhere("SDF has no torque that depends on position"),
        "encoder_offset": exact("joint/pose"),
        "joint_elasticity": nowhere("a motor behind a spring needs a rotor, which SDF has not"),
        "backlash": nowhere("a motor behind a gap needs a rotor, which SDF has not"),
        "presliding_hysteresis": approximate("axis/dynamics/friction, that once sliding", "no bristles before sliding"),
        "saturation": exact("axis/limit/effort"),
        "coupled_transmission": nowhere("damping and friction of SDF act on single joints"),
    }

    def write(self, arm: ArmPhysics, folder: Path) -> tuple[Path, ...]:
        path = folder / "model.sdf"
        write_xml(path, sdf_of(arm))
        return (path,)


def sdf_of(arm: ArmPhysics) -> Element:
    """The arm as SDF."""
    root = Element("sdf", version="1.9")
    model = SubElement(root, "model", name="corrected_arm")
    turn = Rotation.align_vectors([DOWN], [arm.robot.gravity])[0].as_matrix()
    _text(model, "pose", numbers(np.concatenate([np.zeros(3), roll_pitch_yaw(turn)])))
    SubElement(model, "link", name="base")
    weld = SubElement(model, "joint", name="mounting", type="fixed")
    _text(weld, "parent", "world")
    _text(weld, "child", "base")
    tree = arm.robot.body_tree()
    friction = joint_friction(arm)
    for j, body in enumerate(tree):
        parent = tree[body.parent].name if body.parent >= 0 else "base"
        _link(model, body)
        _joint(model, body, parent, arm, j, float(friction[j]))
    return root


def joint_friction(arm: ArmPhysics) -> np.ndarray:
    """One number of dry friction a joint, for formats that have no more, shape (dof,) [N m]."""
    friction = friction_at_rest(arm)
    for bristle in arm.bristles:
        friction[bristle.joint] += bristle.friction
    return friction


def _text(parent: Element, tag: str, text: str) -> Element:
    element = SubElement(parent, tag)
    element.text = text
    return element


def _link(model: Element, body: TreeBody) -> None:
    link = SubElement(model, "link", name=body.name)
    SubElement(link, "pose", relative_to=body.joint).text = "0 0 0 0 0 0"
    inertial = SubElement(link, "inertial")
    _text(inertial, "pose", numbers(np.concatenate([body.centre, np.zeros(3)])))
    _text(inertial, "mass", number(body.mass))
    tensor = SubElement(inertial, "inertia")
    for name, i, k in (("ixx", 0, 0), ("ixy", 0, 1), ("ixz", 0, 2), ("iyy", 1, 1), ("iyz", 1, 2), ("izz", 2, 2)):
        _text(tensor, name, number(body.inertia[i, k]))


def _joint(model: Element, body: TreeBody, parent: str, arm: ArmPhysics, j: int, friction: float) -> None:
    joint = SubElement(model, "joint", name=body.joint, type=body.kind)
    position, rotation = shifted_frame(body, float(arm.shift[j]))
    SubElement(joint, "pose", relative_to=parent).text = numbers(np.concatenate([position, roll_pitch_yaw(rotation)]))
    _text(joint, "parent", parent)
    _text(joint, "child", body.name)
    axis = SubElement(joint, "axis")
    _text(axis, "xyz", numbers(body.axis))
    limit = SubElement(axis, "limit")
    if np.isfinite(body.lower) and np.isfinite(body.upper):
        _text(limit, "lower", number(body.lower))
        _text(limit, "upper", number(body.upper))
    effort = min(body.effort_limit, arm.drives[j].most)
    if np.isfinite(effort):
        _text(limit, "effort", number(effort))
    dynamics = SubElement(axis, "dynamics")
    _text(dynamics, "damping", number(arm.viscous[j]))
    _text(dynamics, "friction", number(friction))
    if arm.stiffness[j]:
        _text(dynamics, "spring_stiffness", number(arm.stiffness[j]))
        _text(dynamics, "spring_reference", number(arm.spring_rest[j]))


def shifted_frame(body: TreeBody, shift: float) -> tuple[np.ndarray, np.ndarray]:
    """Position and axes of a joint's frame in its parent, turned or moved by what its encoder is off."""
    if body.turns:
        return body.position, body.rotation @ Rotation.from_rotvec(shift * body.axis).as_matrix()
    return body.position + body.rotation @ (shift * body.axis), body.rotation
