"""Drake: a URDF with Drake's own tags for rotors, and a script that adds springs and the direction of gravity."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import ClassVar, final
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from lagnet.simulators.corrected_arm.arm_physics import ArmPhysics
from lagnet.simulators.exporter import Exporter, Place, exact, nowhere
from lagnet.simulators.runtime_files import write_runtime
from lagnet.simulators.urdf_text import urdf_of
from lagnet.simulators.xml_text import number, write_xml

DRY = "joints of Drake have damping alone, and its readers leave out friction of a URDF"
SIGNAL = "an actuation port takes the torque at the joint: scale, zero and clock belong into the diagram before it"


@final
class DrakeExporter(Exporter):
    """Drake's MultibodyPlant."""

    name = "drake"
    title = "Drake"
    reads = "Drake ≥ 1.30, with run_drake.py building the plant"
    places: ClassVar[Mapping[str, Place]] = {
        "viscous_friction": exact("joint dynamics damping"),
        "coulomb_friction": nowhere(DRY),
        "asymmetric_friction": nowhere(DRY),
        "stribeck_friction": nowhere(DRY),
        "quadratic_drag": nowhere("damping of Drake's joints is linear in speed"),
        "rotor_inertia": exact("drake:rotor_inertia with drake:gear_ratio 1"),
        "payload": exact("link inertial"),
        "link_inertia": exact("link inertial"),
        "gravity_tilt": exact("mutable_gravity_field().set_gravity_vector in run_drake.py"),
        "joint_spring": exact("RevoluteSpring, PrismaticSpring in run_drake.py"),
        "torque_gain": nowhere(SIGNAL),
        "torque_offset": nowhere(SIGNAL),
        "time_delay": nowhere(SIGNAL),
        "load_dependent_friction": nowhere(DRY),
        "torque_ripple": nowhere("no force element of Drake depends on position as a wave"),
        "encoder_offset": exact("joint origin"),
        "joint_elasticity": nowhere(
            "the motor's side would need a body of its own, which turns with the links before it"
        ),
        "backlash": nowhere("the motor's side would need a body of its own, which turns with the links before it"),
        "presliding_hysteresis": nowhere(DRY),
        "saturation": exact("joint limit effort, the actuator's effort limit"),
        "coupled_transmission": nowhere("rotors and damping of Drake act on single joints"),
    }

    def write(self, arm: ArmPhysics, folder: Path) -> tuple[Path, ...]:
        path = folder / "model.urdf"
        root = urdf_of(arm, bare=False)
        joints = {joint.get("name"): joint for joint in root.findall("joint")}
        root.set("xmlns:drake", "http://drake.mit.edu")
        for j, name in enumerate(arm.robot.joints):
            _joint(joints[name], arm, j)
            _transmission(root, name, float(arm.rotor[j]))
        write_xml(path, root)
        return (path, *write_runtime(arm, folder, "run_drake.py"))


def _joint(joint: Element, arm: ArmPhysics, j: int) -> None:
    for old in joint.findall("dynamics"):
        joint.remove(old)
    SubElement(joint, "dynamics", damping=number(arm.viscous[j]))
    limit = joint.find("limit")
    if limit is not None and np.isfinite(arm.drives[j].most):
        limit.set("effort", number(min(float(limit.get("effort", "inf")), arm.drives[j].most)))


def _transmission(root: Element, joint: str, rotor: float) -> None:
    for old in root.findall("transmission"):
        if any(j.get("name") == joint for j in old.findall("joint")):
            root.remove(old)
    transmission = SubElement(root, "transmission", name=f"{joint}_transmission")
    SubElement(transmission, "type").text = "transmission_interface/SimpleTransmission"
    SubElement(transmission, "joint", name=joint)
    actuator = SubElement(transmission, "actuator", name=joint)
    SubElement(actuator, "drake:rotor_inertia", value=number(rotor))
    SubElement(actuator, "drake:gear_ratio", value="1.0")
