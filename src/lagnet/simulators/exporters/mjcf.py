"""MJCF: damping, frictionloss with solver settings that make it hold, armature, springs, actuators; links that give."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import ClassVar, final
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from lagnet.rigid_body.body_tree import TreeBody
from lagnet.simulators.corrected_arm.arm_physics import ArmPhysics
from lagnet.simulators.corrected_arm.forward_motion import motor_inertia
from lagnet.simulators.exporter import Exporter, Place, approximate, exact
from lagnet.simulators.runtime_files import write_runtime
from lagnet.simulators.xml_text import number, numbers, quaternion, write_xml

TIMESTEP = 0.001  # [s]
FINEST = 2.5e-5  # [s], shortest step for which the histories of delays have room
SOLREF = "0.001 1"  # MuJoCo lifts the time constant to two steps
SOLIMP = "0.9999 0.9999 0.001 0.5 2"  # as hard as MuJoCo allows: friction then holds instead of creeping
LINK, GAP = "_link", "_gap"  # endings of the names of joints between motor and link
LAG_ROOM = 2  # samples that a history keeps beyond the delay


@final
class MjcfExporter(Exporter):
    """MuJoCo's own format."""

    name = "mjcf"
    title = "MuJoCo (MJCF)"
    reads = "MuJoCo ≥ 3.7 (polynomial damping and dcmotor; delays from 3.5, all else from 3.3 on)"
    engine = "mujoco"
    places: ClassVar[Mapping[str, Place]] = {
        "viscous_friction": exact("joint damping"),
        "coulomb_friction": exact(
            "joint frictionloss, solreffriction, solimpfriction",
            "with MuJoCo's default solver settings the joint creeps under load; these hold it",
        ),
        "asymmetric_friction": exact("joint frictionloss (mean) and a constant of the actuator (half the difference)"),
        "stribeck_friction": exact(
            "joint frictionloss, set at every step by run_mujoco.py",
            "model.xml alone holds Fc + Fs, the friction near standstill",
        ),
        "quadratic_drag": exact("joint damping, second coefficient"),
        "rotor_inertia": exact("joint armature"),
        "payload": exact("body inertial"),
        "link_inertia": exact("body inertial"),
        "gravity_tilt": exact("option gravity"),
        "joint_spring": exact("joint stiffness, springref"),
        "torque_gain": exact("actuator gainprm 1/g"),
        "torque_offset": exact("actuator biasprm −b/g"),
        "time_delay": exact("actuator delay, nsample", "the torque acts later than it was logged"),
        "load_dependent_friction": exact(
            "joint frictionloss, set at every step by run_mujoco.py",
            "model.xml alone holds the friction under the weight of the arm in its zero pose",
        ),
        "torque_ripple": exact("actuator dcmotor cogging without inputs"),
        "encoder_offset": exact("joint ref"),
        "joint_elasticity": approximate(
            "a second joint with stiffness behind the motor's",
            "where no rotor inertia is named the motor gets a twentieth of the inertia that it moves",
        ),
        "backlash": approximate(
            "a second joint with a range of ±h behind the motor's",
            "stops are stiff instead of rigid; without a named rotor the motor gets a twentieth of what it moves",
        ),
        "presliding_hysteresis": approximate(
            "actuator dcmotor lugre without inputs", "MuJoCo bends the bristles once a step"
        ),
        "saturation": exact("actuator ctrlrange"),
        "coupled_transmission": exact("tendon/fixed over both joints: damping, frictionloss, armature"),
    }

    def place_of_values(self, name: str, values: Mapping[str, float]) -> Place:
        if name == "time_delay" and values["T"] > 0.0:
            return exact(
                "sensor jointactuatorfrc, delay, nsample", "the read-out of the torque comes late, not the torque"
            )
        return self.places[name]

    def write(self, arm: ArmPhysics, folder: Path) -> tuple[Path, ...]:
        path = folder / "model.xml"
        write_xml(path, mjcf_of(arm))
        return (path, *write_runtime(arm, folder, "run_mujoco.py"))


def mjcf_of(arm: ArmPhysics) -> Element:
    """The arm as MJCF."""
    tree = arm.robot.body_tree()
    root = Element("mujoco", model="corrected_arm")
    SubElement(root, "compiler", angle="radian", autolimits="true")
    SubElement(
        root,
        "option",
        gravity=numbers(arm.robot.gravity),
        timestep=number(TIMESTEP),
        integrator="implicitfast",
        solver="Newton",
        iterations="100",
        tolerance="1e-10",
    )
    bodies = {-1: SubElement(root, "worldbody")}
    for j, body in enumerate(tree):
        bodies[j] = _body(bodies[body.parent], body, arm, j)
    _tendons(root, arm, tree)
    _actuators(root, arm, tree)
    _sensors(root, arm, tree)
    return root


def _body(parent: Element, body: TreeBody, arm: ArmPhysics, j: int) -> Element:
    element = SubElement(
        parent, "body", name=body.name, pos=numbers(body.position), quat=numbers(quaternion(body.rotation))
    )
    if arm.compliant[j]:
        _motor_side(element, body, arm, j)
        element = SubElement(element, "body", name=body.name + LINK)
        _link_side(element, body, arm, j)
    else:
        joint = _joint(element, body, body.joint)
        _on_motor(joint, body, arm, j, float(arm.rotor[j]))
    tensor = body.inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    SubElement(element, "inertial", pos=numbers(body.centre), mass=number(body.mass), fullinertia=numbers(tensor))
    return element


def _joint(element: Element, body: TreeBody, name: str) -> Element:
    kind = "hinge" if body.turns else "slide"
    return SubElement(element, "joint", name=name, type=kind, axis=numbers(body.axis))


def _motor_side(element: Element, body: TreeBody, arm: ArmPhysics, j: int) -> None:
    """The motor's joint on a body of next to no mass; its rotor is the armature."""
    joint = _joint(element, body, body.joint)
    _on_motor(joint, body, arm, j, float(motor_inertia(arm)[j]))
    SubElement(element, "inertial", pos="0 0 0", mass="1e-9", diaginertia="1e-12 1e-12 1e-12")


def _link_side(element: Element, body: TreeBody, arm: ArmPhysics, j: int) -> None:
    if np.isfinite(arm.elasticity[j]):
        joint = _joint(element, body, body.joint + LINK)
        joint.set("stiffness", number(arm.elasticity[j]))
        if arm.twist_damping[j]:
            joint.set("damping", number(arm.twist_damping[j]))
    if arm.half_gap[j] > 0.0:
        gap = _joint(element, body, body.joint + GAP)
        gap.set("range", numbers(np.array([-1.0, 1.0]) * arm.half_gap[j]))
        gap.attrib.update(solreflimit=SOLREF, solimplimit=SOLIMP)


def _on_motor(joint: Element, body: TreeBody, arm: ArmPhysics, j: int, rotor: float) -> None:
    if np.isfinite(body.lower) and np.isfinite(body.upper):
        joint.set("range", numbers(np.array([body.lower, body.upper])))
    if arm.shift[j]:
        joint.set("ref", number(-arm.shift[j]))
    if rotor:
        joint.set("armature", number(rotor))
    if arm.quadratic[j]:
        joint.set("damping", numbers(np.array([arm.viscous[j], arm.quadratic[j], 0.0])))
    elif arm.viscous[j]:
        joint.set("damping", number(arm.viscous[j]))
    if arm.stiffness[j]:
        joint.attrib.update(stiffness=number(arm.stiffness[j]), springref=number(arm.spring_rest[j]))
    friction = friction_at_rest(arm)[j]
    if friction:
        joint.attrib.update(frictionloss=number(friction), solreffriction=SOLREF, solimpfriction=SOLIMP)


def friction_at_rest(arm: ArmPhysics) -> np.ndarray:
    """Dry friction that holds each joint in the zero pose, shape (dof,) [N m]."""
    weight = arm.robot.gravity_torque(np.zeros((1, arm.n_dof)) + arm.shift)[0]
    friction = arm.mean_friction + arm.load_friction * np.abs(weight)
    for term in arm.stribeck:
        friction[term.joint] += term.extra
    return friction


def _tendons(root: Element, arm: ArmPhysics, tree: tuple[TreeBody, ...]) -> None:
    if not arm.couplings:
        return
    group = SubElement(root, "tendon")
    for term in arm.couplings:
        fixed = SubElement(group, "fixed", name=f"{tree[term.joint].joint}_coupled")
        values = {"damping": term.viscous, "frictionloss": term.dry, "armature": term.rotor}
        fixed.attrib.update({key: number(value) for key, value in values.items() if value})
        if term.dry:
            fixed.attrib.update(solreffriction=SOLREF, solimpfriction=SOLIMP)
        SubElement(fixed, "joint", joint=tree[term.joint].joint, coef="1")
        SubElement(fixed, "joint", joint=tree[term.joint - 1].joint, coef=number(term.ratio))


def _actuators(root: Element, arm: ArmPhysics, tree: tuple[TreeBody, ...]) -> None:
    """One actuator a joint, in their order, that takes what a log holds; then what acts without a command."""
    group = SubElement(root, "actuator")
    for j, (body, drive) in enumerate(zip(tree, arm.drives, strict=True)):
        actuator = SubElement(group, "general", name=body.joint, joint=body.joint, gainprm=number(1.0 / drive.gain))
        constant = -drive.offset / drive.gain - arm.friction_bias[j]
        if constant:
            actuator.attrib.update(biastype="affine", biasprm=numbers(np.array([constant, 0.0, 0.0])))
        if np.isfinite(drive.upper):
            actuator.set("ctrlrange", numbers(np.array([drive.lower, drive.upper])))
        if drive.hold:
            actuator.attrib.update(delayed(drive.hold))
    for k, ripple in enumerate(arm.ripples):
        cogging = np.array([-ripple.amplitude, ripple.order, ripple.phase])
        passive = _passive(group, f"{tree[ripple.joint].joint}_ripple_{k}", tree[ripple.joint])
        passive.set("cogging", numbers(cogging))
    for k, bristle in enumerate(arm.bristles):
        law = np.array([bristle.stiffness, 0.0, bristle.friction, bristle.friction, 1.0])
        passive = _passive(group, f"{tree[bristle.joint].joint}_bristles_{k}", tree[bristle.joint])
        passive.set("lugre", numbers(law))


def _passive(group: Element, name: str, body: TreeBody) -> Element:
    """A motor without electricity and inputs: cogging and bristles alone."""
    return SubElement(group, "dcmotor", name=name, joint=body.joint, input="none", resistance="1", motorconst="0")


def delayed(seconds: float) -> dict[str, str]:
    """Attributes of an actuator or a sensor that is late."""
    return {"delay": number(seconds), "nsample": str(int(np.ceil(seconds / FINEST)) + LAG_ROOM)}


def _sensors(root: Element, arm: ArmPhysics, tree: tuple[TreeBody, ...]) -> None:
    late = [(b, d) for b, d in zip(tree, arm.drives, strict=True) if d.late]
    if late:
        group = SubElement(root, "sensor")
        for body, drive in late:
            sensor = SubElement(group, "jointactuatorfrc", name=f"{body.joint}_torque", joint=body.joint)
            sensor.attrib.update(delayed(drive.late))
