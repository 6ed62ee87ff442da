"""PyBullet: a URDF of the bodies, and a script that drives it by position commands."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import ClassVar, final

from lagnet.simulators.corrected_arm.servo_arm import ServoArm, settings_of_servos
from lagnet.simulators.exporter import Place, approximate, exact
from lagnet.simulators.exporters.pybullet import PyBulletExporter
from lagnet.simulators.runtime_files import write_runtime
from lagnet.simulators.servo_exporters.servo_exporter import LIKE_LOAD, ServoExporter, shared_places
from lagnet.simulators.urdf_text import urdf_of
from lagnet.simulators.xml_text import write_xml

SCRIPT = "run_servo_pybullet.py"
LAW = exact(f"the controller in {SCRIPT}")
FRICTION = exact(f"friction that {SCRIPT} solves at every step")
MODULES = (SCRIPT, "run_pybullet.py", "friction_impulse.py", "servo_law.py", "surface_force.py")


@final
class PyBulletServoExporter(ServoExporter):
    """PyBullet, by a runnable script."""

    torques = PyBulletExporter()
    places: ClassVar[Mapping[str, Place]] = {
        **shared_places(torques),
        "viscous_friction": exact(f"a damper in {SCRIPT}, taken at the end of each step"),
        "coulomb_friction": FRICTION,
        "stribeck_friction": FRICTION,
        "static_friction": approximate(FRICTION.element, "friction at rest ends at 1e-3 rad/s instead of at once"),
        "load_dependent_friction": FRICTION,
        **dict.fromkeys(LIKE_LOAD, FRICTION),
        "load_stribeck_friction": FRICTION,
        "gain_error": LAW,
        "position_bias": LAW,
        "command_delay": LAW,
        "dead_band": LAW,
        "duty_saturation": LAW,
        "torque_saturation": LAW,
        "torque_offset": exact(f"a constant torque in {SCRIPT}"),
        "surface_contact": exact(f"a force at the touching point in {SCRIPT}, taken at the end of each step"),
        "load_error": exact("gains, friction, rotor and springs of the joint divided by g"),
    }

    def write(self, arm: ServoArm, folder: Path) -> tuple[Path, ...]:
        path = folder / "model.urdf"
        write_xml(path, urdf_of(arm.arm, bare=True))
        return (path, *write_runtime(arm.arm, folder, *MODULES, more={"servo": settings_of_servos(arm)}))
