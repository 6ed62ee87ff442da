"""URDF: bodies, damping, friction; and which readers ignore what."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import ClassVar, final
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from lagnet.simulators.corrected_arm.arm_physics import ArmPhysics
from lagnet.simulators.exporter import Exporter, Place, approximate, exact, nowhere
from lagnet.simulators.exporters.mjcf import friction_at_rest
from lagnet.simulators.urdf_text import tilted_root, urdf_of
from lagnet.simulators.xml_text import number, write_xml

READERS = "MuJoCo and PyBullet read it; Drake reads damping alone; Pinocchio's algorithms ignore both"
IGNORED = "MuJoCo reads it with settings that creep; PyBullet reads it and ignores it, Drake and Pinocchio ignore it"
SIGNAL = "a URDF has no actuator whose torque could be scaled, moved or delayed"


@final
class UrdfExporter(Exporter):
    """The Unified Robot Description Format."""

    name = "urdf"
    title = "URDF"
    reads = "every simulator, each in part"
    engine = None
    other_engines = ("mujoco", "pybullet")
    places: ClassVar[Mapping[str, Place]] = {
        "viscous_friction": exact("joint dynamics damping", READERS),
        "coulomb_friction": approximate("joint dynamics friction", IGNORED),
        "asymmetric_friction": approximate("joint dynamics friction, mean of both directions", IGNORED),
        "stribeck_friction": approximate("joint dynamics friction, that near standstill", IGNORED),
        "quadratic_drag": nowhere("damping of a URDF is linear in speed"),
        "rotor_inertia": nowhere("a URDF has no rotors; on the link it would turn with the joints before it too"),
        "payload": exact("link inertial"),
        "link_inertia": exact("link inertial"),
        "gravity_tilt": exact("fixed joint `mounting` between a level world and the base"),
        "joint_spring": nowhere("a URDF has no springs"),
        "torque_gain": nowhere(SIGNAL),
        "torque_offset": nowhere(SIGNAL),
        "time_delay": nowhere(SIGNAL),
        "load_dependent_friction": approximate(
            "joint dynamics friction, that under the weight of the zero pose", IGNORED
        ),
        "torque_ripple": nowhere("a URDF has no torque that depends on position"),
        "encoder_offset": exact("joint origin"),
        "joint_elasticity": nowhere("a URDF has no springs between motor and link"),
        "backlash": nowhere("a motor behind a gap needs a rotor, which a URDF has not"),
        "presliding_hysteresis": approximate("joint dynamics friction, that once sliding", IGNORED),
        "saturation": approximate("joint limit effort", "MuJoCo applies it; PyBullet does not under torque control"),
        "coupled_transmission": nowhere("damping and friction of a URDF act on single joints"),
    }

    def write(self, arm: ArmPhysics, folder: Path) -> tuple[Path, ...]:
        path = folder / "model.urdf"
        root = urdf_of(arm, bare=False)
        tilted_root(root, arm.robot.gravity)
        add_dynamics(root, arm)
        write_xml(path, root)
        return (path,)


def add_dynamics(root: Element, arm: ArmPhysics) -> None:
    """Damping, friction and the limit of effort at every moving joint."""
    joints = {joint.get("name"): joint for joint in root.findall("joint")}
    friction = friction_at_rest(arm)
    for bristle in arm.bristles:
        friction[bristle.joint] += bristle.friction
    for j, name in enumerate(arm.robot.joints):
        joint = joints[name]
        for old in joint.findall("dynamics"):
            joint.remove(old)
        if arm.viscous[j] or friction[j]:
            SubElement(joint, "dynamics", damping=number(arm.viscous[j]), friction=number(friction[j]))
        limit, drive = joint.find("limit"), arm.drives[j]
        if limit is not None and np.isfinite(drive.most):
            limit.set("effort", number(min(float(limit.get("effort", "inf")), drive.most)))
