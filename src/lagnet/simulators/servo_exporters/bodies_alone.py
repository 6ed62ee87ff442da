"""URDF and SDF: bodies and joints as under torques; they have no controllers."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import ClassVar, final

from lagnet.simulators.corrected_arm.servo_arm import ServoArm
from lagnet.simulators.exporter import Place, approximate
from lagnet.simulators.exporters.sdf import SdfExporter
from lagnet.simulators.exporters.urdf import UrdfExporter
from lagnet.simulators.servo_exporters.servo_exporter import ServoExporter, shared_places, without_controller

DIVIDED = approximate("damping and friction of the joint divided by g", "divide the gains of its controller as well")


@final
class UrdfServoExporter(ServoExporter):
    """The Unified Robot Description Format."""

    torques = UrdfExporter()
    places: ClassVar[Mapping[str, Place]] = {
        **shared_places(torques),
        **without_controller("a URDF"),
        "duty_saturation": torques.places["saturation"],
        "load_error": DIVIDED,
    }

    def write(self, arm: ServoArm, folder: Path) -> tuple[Path, ...]:
        return self.torques.write(arm.arm, folder)


@final
class SdfServoExporter(ServoExporter):
    """Simulation Description Format."""

    torques = SdfExporter()
    places: ClassVar[Mapping[str, Place]] = {
        **shared_places(torques),
        **without_controller("SDF"),
        "duty_saturation": torques.places["saturation"],
        "load_error": DIVIDED,
    }

    def write(self, arm: ServoArm, folder: Path) -> tuple[Path, ...]:
        return self.torques.write(arm.arm, folder)
