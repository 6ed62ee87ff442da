"""USD and Isaac Lab: the drive of each joint with the gains of its servo; delays in Isaac Lab alone."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import ClassVar, final

from lagnet.rigid_body.descriptions.writing import write_text
from lagnet.servos.parameters import DELAY, KD, KP
from lagnet.simulators.corrected_arm.servo_arm import ServoArm
from lagnet.simulators.exporter import Place, approximate, exact, nowhere
from lagnet.simulators.exporters.isaaclab import PHYSICS_STEP, IsaacLabExporter, actuators_text, joint_settings
from lagnet.simulators.exporters.usd import UsdExporter, usd_of
from lagnet.simulators.servo_exporters.servo_exporter import ServoExporter, shared_places

PLAIN = "the drive is stiffness, damping and a limit of force"
NO_INTEGRAL: Mapping[str, Place] = {"ki": nowhere(PLAIN)}
DRIVEN: Mapping[str, Place] = {
    "position_bias": nowhere(f"{PLAIN}: take the bias off the commands"),
    "dead_band": nowhere(PLAIN),
    "torque_saturation": nowhere(PLAIN),
    "torque_offset": nowhere(PLAIN),
    "joint_spring": nowhere("the spring of a joint there is its drive, which the servo needs"),
    "load_error": exact("gains, friction and rotor of the joint divided by g"),
}


@final
class UsdServoExporter(ServoExporter):
    """Universal Scene Description with physics."""

    torques = UsdExporter()
    apart = NO_INTEGRAL
    places: ClassVar[Mapping[str, Place]] = {
        **shared_places(torques),
        **DRIVEN,
        "gain_error": exact("PhysicsDriveAPI stiffness, damping", "per degree"),
        "command_delay": nowhere("USD states what a joint is, not what its command passes through"),
        "duty_saturation": exact("PhysicsDriveAPI maxForce"),
    }

    def write(self, arm: ServoArm, folder: Path) -> tuple[Path, ...]:
        path = folder / "model.usda"
        write_text(path, usd_of(arm.arm, gains_of(arm)))
        return (path,)


@final
class IsaacLabServoExporter(ServoExporter):
    """Isaac Lab's actuator configurations."""

    torques = IsaacLabExporter()
    apart = NO_INTEGRAL
    places: ClassVar[Mapping[str, Place]] = {
        **shared_places(torques),
        **DRIVEN,
        "gain_error": exact("stiffness, damping"),
        "command_delay": approximate("DelayedPDActuatorCfg min_delay, max_delay", "whole physics steps"),
        "duty_saturation": exact("effort_limit_sim"),
    }

    def write(self, arm: ServoArm, folder: Path) -> tuple[Path, ...]:
        settings = joint_settings(arm.arm)
        for name, law in zip(arm.arm.robot.joints, arm.laws, strict=True):
            values, steps = settings[name]["values"], round(float(law[DELAY]) / PHYSICS_STEP)
            values |= {"stiffness": float(law[KP]), "damping": float(law[KD])}
            if steps:
                values |= {"min_delay": steps, "max_delay": steps}
                settings[name]["kind"] = "delayed"
        path = folder / "actuators.py"
        write_text(path, actuators_text(arm.arm, settings))
        return (path, *UsdServoExporter().write(arm, folder))


def gains_of(arm: ServoArm) -> tuple[tuple[float, float], ...]:
    """Gains kp and kd of every joint [N m/rad, N m s/rad]."""
    return tuple((float(law[KP]), float(law[KD])) for law in arm.laws)
