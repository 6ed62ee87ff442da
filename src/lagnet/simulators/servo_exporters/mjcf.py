"""MJCF: position actuators with gains, bias, delay and limit of each servo; the surface as a plane."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import ClassVar, final
from xml.etree.ElementTree import Element, SubElement

import numpy as np
from scipy.spatial.transform import Rotation

from lagnet.rigid_body.body_tree import TreeBody
from lagnet.rollout.surface import BODY, FRICTION, HEIGHT, PX, PZ
from lagnet.servos.parameters import BIAS, DELAY, KD, KP, OFFSET
from lagnet.simulators.corrected_arm.servo_arm import ServoArm, settings_of_servos
from lagnet.simulators.exporter import Place, approximate, exact
from lagnet.simulators.exporters.mjcf import LINK, MjcfExporter, delayed, mjcf_of
from lagnet.simulators.runtime_files import write_runtime
from lagnet.simulators.servo_exporters.servo_exporter import ServoExporter, shared_places
from lagnet.simulators.xml_text import number, numbers, quaternion, write_xml

SCRIPT = "run_servo_mujoco.py"
FOLLOWS = "joint frictionloss, set at every step by run_servo_mujoco.py"
ALONE = "model.xml alone holds the friction at rest under the weight of the zero pose"
TIP = 0.002  # [m], radius of the sphere that touches the surface
CONSTANT = "_offset"  # ending of the name of an actuator of constant force


@final
class MjcfServoExporter(ServoExporter):
    """MuJoCo's own format."""

    torques = MjcfExporter()
    apart: ClassVar[Mapping[str, Place]] = {"ki": exact(f"{SCRIPT}, which sends that joint torques")}
    places: ClassVar[Mapping[str, Place]] = {
        **shared_places(torques),
        "gain_error": exact("actuator gainprm kp, biasprm −kp δ, −kp, −kd"),
        "position_bias": exact("actuator biasprm −kp δ"),
        "command_delay": exact(
            "actuator delay, nsample", f"MuJoCo's history begins with zeros; {SCRIPT} fills it with the first command"
        ),
        "dead_band": exact(f"{SCRIPT}, which sends that joint torques"),
        "duty_saturation": exact("actuator forcerange"),
        "torque_saturation": exact(f"{SCRIPT}, which sends that joint torques"),
        "torque_offset": exact("a further actuator of constant force"),
        "load_error": exact("gains, friction, rotor and springs of the joint divided by g"),
        "static_friction": approximate(FOLLOWS, f"friction at rest ends at 1e-3 rad/s instead of at once; {ALONE}"),
        "stribeck_friction": exact(FOLLOWS, ALONE),
        "load_dependent_friction": exact(FOLLOWS, ALONE),
        "directional_load_friction": exact(FOLLOWS, ALONE),
        "quadratic_load_friction": exact(FOLLOWS, "model.xml alone leaves it out"),
        "gear_friction": exact(FOLLOWS, ALONE),
        "load_stribeck_friction": exact(FOLLOWS, "model.xml alone leaves it out"),
        "surface_contact": approximate(
            "a plane and a sphere on the body that touches", "as hard as MuJoCo's contacts, not as hard as identified"
        ),
    }

    def write(self, arm: ServoArm, folder: Path) -> tuple[Path, ...]:
        path, root = folder / "model.xml", mjcf_of(arm.arm)
        for old in [*root.findall("actuator"), *root.findall("sensor")]:
            root.remove(old)
        tree = arm.arm.robot.body_tree()
        _actuators(root, arm, tree)
        if arm.surface is not None:
            _surface(root, arm, tree)
        write_xml(path, root)
        more = {"servo": settings_of_servos(arm)}
        return (path, *write_runtime(arm.arm, folder, SCRIPT, "servo_law.py", more=more))


def _actuators(root: Element, arm: ServoArm, tree: tuple[TreeBody, ...]) -> None:
    """Position actuators in the order of the joints, then forces that act without a command."""
    group = SubElement(root, "actuator")
    for body, law, most in zip(tree, arm.laws, arm.torque_limit, strict=True):
        kp = law[KP]
        feedback = numbers(np.array([-kp * law[BIAS], -kp, -law[KD]]))
        actuator = SubElement(group, "general", name=body.joint, joint=body.joint, gainprm=number(kp))
        actuator.attrib.update(biastype="affine", biasprm=feedback)
        if np.isfinite(most):
            actuator.set("forcerange", numbers(np.array([-most, most])))
        if law[DELAY] > 0.0:
            actuator.attrib.update(delayed(float(law[DELAY])))
    for body, law in zip(tree, arm.laws, strict=True):
        if law[OFFSET]:
            constant = SubElement(group, "general", name=body.joint + CONSTANT, joint=body.joint, gainprm="0")
            constant.attrib.update(biastype="affine", biasprm=numbers(np.array([law[OFFSET], 0.0, 0.0])))


def _surface(root: Element, arm: ServoArm, tree: tuple[TreeBody, ...]) -> None:
    """A plane at right angles to gravity, and the point that may rest on it as a small sphere."""
    assert arm.surface is not None
    up = -np.asarray(arm.arm.robot.gravity)
    up = up / np.linalg.norm(up)
    turn = Rotation.align_vectors([up], [[0.0, 0.0, 1.0]])[0].as_matrix()
    world, j = root.find("worldbody"), int(arm.surface[BODY])
    assert world is not None
    rubbing = {"friction": f"{number(arm.surface[FRICTION])} 0 0", "condim": "3" if arm.surface[FRICTION] else "1"}
    at = numbers((arm.surface[HEIGHT] - TIP) * up)
    plane = {"name": "surface", "type": "plane", "size": "0 0 0.05", "pos": at, "quat": numbers(quaternion(turn))}
    SubElement(world, "geom", plane | rubbing)
    name = tree[j].name + (LINK if arm.arm.compliant[j] else "")
    body = next(b for b in root.iter("body") if b.get("name") == name)
    tip = {"name": "tip", "type": "sphere", "size": number(TIP), "pos": numbers(arm.surface[PX : PZ + 1])}
    SubElement(body, "geom", tip | rubbing | {"mass": "0"})
