"""What every exporter of servo-driven arms answers: the place of each cause that motion can show, and the files."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from pathlib import Path
from typing import ClassVar

from lagnet.servos.catalogue import SERVO_CATALOGUE
from lagnet.simulators.corrected_arm.servo_arm import ServoArm
from lagnet.simulators.exporter import Exporter, Place, nowhere
from lagnet.simulators.measured import measured_servo_errors

WHOLE_ARM = ("payload", "surface_contact")
CAUSES = (*SERVO_CATALOGUE, *WHOLE_ARM)
SHARED = (
    *("viscous_friction", "coulomb_friction", "stribeck_friction", "rotor_inertia", "load_dependent_friction"),
    *("quadratic_drag", "joint_spring", "joint_elasticity", "backlash", "payload"),
)  # causes that a torque tells of as well: what a simulator has for them is the same
LIKE_LOAD = ("directional_load_friction", "quadratic_load_friction", "gear_friction")
NO_SURFACE = nowhere("the exported bodies have no shapes: put a level surface at its height into your world")
CAUSE_OF = {
    **{"kp": "gain_error", "kd": "gain_error", "ki": "gain_error", "bias": "position_bias"},
    **{"delay": "command_delay", "dead_band": "dead_band", "torque_limit": "duty_saturation"},
    **{"voltage_share": "duty_saturation", "full_error": "duty_saturation", "saturation": "torque_saturation"},
    **{"rotor": "rotor_inertia", "viscous": "viscous_friction", "back_emf": "viscous_friction"},
    **{"quadratic": "quadratic_drag", "coulomb": "coulomb_friction", "static": "static_friction"},
    **{"stribeck_speed": "stribeck_friction", "load_driving": "directional_load_friction"},
    **{"load_driven": "directional_load_friction", "load_squared": "quadratic_load_friction"},
    **{"load_motor": "gear_friction", "load_stribeck": "load_stribeck_friction", "offset": "torque_offset"},
    **{"load_gain": "load_error", "spring": "joint_spring", "spring_rest": "joint_spring", "gap": "backlash"},
    **{"stiffness": "joint_elasticity", "twist_damping": "joint_elasticity", "encoder_side": "joint_elasticity"},
}
"""The cause whose element holds a parameter of a law."""


class ServoExporter(ABC):
    """One simulator or format, for arms driven by position commands.

    A final class declares the exporter of the same arm under torques, a place for every cause, and how it is written;
    `apart` holds places of single parameters of a law that are not those of their cause.
    """

    torques: ClassVar[Exporter]
    places: ClassVar[Mapping[str, Place]]
    apart: ClassVar[Mapping[str, Place]] = {}

    @property
    def name(self) -> str:
        """As `--to` takes it."""
        return self.torques.name

    def place_of_parameter(self, name: str) -> Place:
        """Where a parameter of a law goes."""
        return self.apart.get(name, self.places[CAUSE_OF[name]])

    @property
    def reads(self) -> str:
        """What reads the files, and from which version on."""
        return self.torques.reads

    def measured(self, effect: str) -> Mapping[str, float]:
        """Measured error of a cause that was written, by engine, in shares of what it moves."""
        return measured_servo_errors(self.name, effect)

    @abstractmethod
    def write(self, arm: ServoArm, folder: Path) -> tuple[Path, ...]:
        """Write the model and what belongs to it.

        Returns:
            The files, the one to open first.
        """


def shared_places(exporter: Exporter) -> dict[str, Place]:
    """Places of what torques tell of as well; friction by load in other forms is written as that of one form."""
    places = {name: exporter.places[name] for name in SHARED}
    load = places["load_dependent_friction"]
    return {
        **places,
        "static_friction": places["stribeck_friction"],
        **dict.fromkeys(LIKE_LOAD, load),
        "load_stribeck_friction": load,
        "surface_contact": NO_SURFACE,
    }


def without_controller(what: str) -> dict[str, Place]:
    """Places of a format that has bodies and no controllers."""
    reason = nowhere(f"{what} has no position controller: export.json holds the numbers for yours")
    drive = ("gain_error", "position_bias", "command_delay", "dead_band", "torque_saturation", "torque_offset")
    return dict.fromkeys(drive, reason)
