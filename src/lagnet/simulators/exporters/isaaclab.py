"""Isaac Lab: a USD of the bodies, and the settings of its actuators as a short module."""

from __future__ import annotations

import pprint
from collections.abc import Mapping
from pathlib import Path
from typing import Any, ClassVar, final

import numpy as np

from lagnet.rigid_body.descriptions.writing import write_text
from lagnet.simulators.corrected_arm.arm_physics import ArmPhysics
from lagnet.simulators.exporter import Exporter, Place, approximate, exact, nowhere
from lagnet.simulators.exporters.sdf import joint_friction
from lagnet.simulators.exporters.usd import UsdExporter

USD = UsdExporter.places
PHYSICS_STEP = 0.005  # [s], Isaac Lab's usual one; delays are counted in steps
HEAD = '''"""Actuators of the corrected arm for Isaac Lab; model.usda beside it holds the bodies.

Angles are in rad here, as Isaac Lab has them; USD has degrees. Delays are counted in physics steps of PHYSICS_STEP:
count anew for another. Stiffness and damping of the position control are yours: None leaves them as the USD has them.
"""

PHYSICS_STEP = {step}
SETTINGS = {settings}


def actuators():
    """One group of actuators a joint, for `ArticulationCfg.actuators`."""
    from isaaclab.actuators import DelayedPDActuatorCfg, ImplicitActuatorCfg

    kinds = {{"implicit": ImplicitActuatorCfg, "delayed": DelayedPDActuatorCfg}}
    return {{name: kinds[s["kind"]](joint_names_expr=[name], **s["values"]) for name, s in SETTINGS.items()}}
'''


@final
class IsaacLabExporter(Exporter):
    """Isaac Lab's actuator configurations."""

    name = "isaaclab"
    title = "Isaac Lab"
    reads = "Isaac Lab ≥ 2.3"
    places: ClassVar[Mapping[str, Place]] = {
        **USD,
        "viscous_friction": exact("viscous_friction", "N m s/rad here, per degree in USD"),
        "coulomb_friction": exact("friction, dynamic_friction", "efforts [N m] since Isaac Sim 5"),
        "asymmetric_friction": approximate(
            "friction, dynamic_friction: mean of both directions", "they have no direction"
        ),
        "stribeck_friction": approximate("friction Fc + Fs, dynamic_friction Fc", "it falls at once, not over v_s"),
        "rotor_inertia": exact("armature"),
        "gravity_tilt": exact("SimulationCfg gravity, written as GRAVITY beside PHYSICS_STEP"),
        "joint_spring": nowhere("a drive's stiffness there follows position commands; set model.usda's drive instead"),
        "time_delay": approximate(
            "DelayedPDActuatorCfg min_delay, max_delay", "whole physics steps; the torque acts later than it was logged"
        ),
        "load_dependent_friction": approximate(
            "friction, dynamic_friction: those under the weight of the zero pose", "they do not follow the load"
        ),
        "presliding_hysteresis": approximate(
            "friction, dynamic_friction: that once sliding", "no bristles before sliding"
        ),
        "saturation": exact("effort_limit_sim"),
    }

    def place_of_values(self, name: str, values: Mapping[str, float]) -> Place:
        if name == "time_delay" and values["T"] > 0.0:
            return nowhere("the log's torque is late, not the arm's: move its clock")
        return self.places[name]

    def write(self, arm: ArmPhysics, folder: Path) -> tuple[Path, ...]:
        path = folder / "actuators.py"
        write_text(path, actuators_text(arm, joint_settings(arm)))
        return (path, *UsdExporter().write(arm, folder))


def joint_settings(arm: ArmPhysics) -> dict[str, dict[str, Any]]:
    """Kind and values of the actuator of every joint, by the joint's name."""
    friction = joint_friction(arm)
    return {name: _settings(arm, j, float(friction[j])) for j, name in enumerate(arm.robot.joints)}


def actuators_text(arm: ArmPhysics, settings: Mapping[str, Any]) -> str:
    """The module with the settings of the actuators."""
    text = HEAD.format(step=PHYSICS_STEP, settings=pprint.pformat(dict(settings), width=110, sort_dicts=False))
    gravity = tuple(float(g) for g in arm.robot.gravity)
    return text.replace("\nSETTINGS", f"\nGRAVITY = {gravity}\nSETTINGS", 1)


def _settings(arm: ArmPhysics, j: int, friction: float) -> dict[str, Any]:
    """Kind and values of the actuator of one joint."""
    drive = arm.drives[j]
    extra = sum(t.extra for t in arm.stribeck if t.joint == j)
    values: dict[str, Any] = {
        "stiffness": None,
        "damping": None,
        "armature": float(arm.rotor[j]),
        "friction": friction,
        "dynamic_friction": friction - extra,
        "viscous_friction": float(arm.viscous[j]),
    }
    if np.isfinite(drive.most):
        values["effort_limit_sim"] = drive.most
    steps = round(drive.hold / PHYSICS_STEP)
    if steps:
        values |= {"min_delay": steps, "max_delay": steps}
    return {"kind": "delayed" if steps else "implicit", "values": values}
