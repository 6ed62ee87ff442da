"""Every simulator that servo-driven arms are written for, by the name that `--to` takes."""

from __future__ import annotations

from lagnet.simulators.servo_exporters.bodies_alone import SdfServoExporter, UrdfServoExporter
from lagnet.simulators.servo_exporters.drake import DrakeServoExporter
from lagnet.simulators.servo_exporters.mjcf import MjcfServoExporter
from lagnet.simulators.servo_exporters.pybullet import PyBulletServoExporter
from lagnet.simulators.servo_exporters.servo_exporter import ServoExporter
from lagnet.simulators.servo_exporters.usd import IsaacLabServoExporter, UsdServoExporter

_EXPORTERS: tuple[ServoExporter, ...] = (
    MjcfServoExporter(),
    PyBulletServoExporter(),
    UrdfServoExporter(),
    SdfServoExporter(),
    UsdServoExporter(),
    DrakeServoExporter(),
    IsaacLabServoExporter(),
)

SERVO_EXPORTERS: dict[str, ServoExporter] = {exporter.name: exporter for exporter in _EXPORTERS}
