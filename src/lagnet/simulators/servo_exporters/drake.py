"""Drake: its own PD controllers of actuators, set by run_drake.py."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import ClassVar, final

from lagnet.simulators.corrected_arm.servo_arm import ServoArm, settings_of_servos
from lagnet.simulators.exporter import Place, exact, nowhere
from lagnet.simulators.exporters.drake import DrakeExporter
from lagnet.simulators.runtime_files import write_runtime
from lagnet.simulators.servo_exporters.servo_exporter import ServoExporter, shared_places

BEFORE = nowhere("Drake's controllers of actuators are kp and kd: what a command passes through belongs before them")


@final
class DrakeServoExporter(ServoExporter):
    """Drake's MultibodyPlant."""

    torques = DrakeExporter()
    apart: ClassVar[Mapping[str, Place]] = {
        "ki": nowhere("actuators have kp and kd: its torque belongs into the plant's actuation port")
    }
    places: ClassVar[Mapping[str, Place]] = {
        **shared_places(torques),
        "gain_error": exact("JointActuator.set_controller_gains in run_drake.py"),
        "position_bias": BEFORE,
        "command_delay": BEFORE,
        "dead_band": BEFORE,
        "torque_saturation": BEFORE,
        "torque_offset": nowhere("a constant torque belongs into the plant's actuation port"),
        "duty_saturation": exact("joint limit effort, the actuator's effort limit"),
        "load_error": exact("gains, damping, rotor and springs of the joint divided by g"),
    }

    def write(self, arm: ServoArm, folder: Path) -> tuple[Path, ...]:
        model, *_ = self.torques.write(arm.arm, folder)
        more = {"servo": settings_of_servos(arm)}
        return (model, *write_runtime(arm.arm, folder, "run_drake.py", more=more))
