"""PyBullet: a URDF of the bodies, and a script that sets dynamics, motors and a torque call-back at every step."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import ClassVar, final

from lagnet.simulators.corrected_arm.arm_physics import ArmPhysics
from lagnet.simulators.exporter import Exporter, Place, approximate, exact
from lagnet.simulators.runtime_files import write_runtime
from lagnet.simulators.urdf_text import urdf_of
from lagnet.simulators.xml_text import write_xml

CALL_BACK = "torque call-back in run_pybullet.py"


@final
class PyBulletExporter(Exporter):
    """PyBullet, by a runnable script."""

    name = "pybullet"
    title = "PyBullet"
    reads = "PyBullet ≥ 3.2.5, with run_pybullet.py stepping it"
    engine = "pybullet"
    places: ClassVar[Mapping[str, Place]] = {
        "viscous_friction": exact("changeDynamics jointDamping"),
        "coulomb_friction": exact(
            "VELOCITY_CONTROL with target 0 and force Fc",
            "beside rotors and coupled motors run_pybullet.py solves friction itself; that of a URDF is ignored",
        ),
        "asymmetric_friction": exact(f"VELOCITY_CONTROL (mean) and {CALL_BACK} (half the difference)"),
        "stribeck_friction": exact("VELOCITY_CONTROL, its force set at every step"),
        "quadratic_drag": exact(CALL_BACK),
        "rotor_inertia": exact(f"{CALL_BACK}: M (M + I_a)⁻¹ (τ − h) + h", "PyBullet has no armature"),
        "payload": exact("link inertial of model.urdf"),
        "link_inertia": exact("link inertial of model.urdf"),
        "gravity_tilt": exact("setGravity"),
        "joint_spring": exact(CALL_BACK),
        "torque_gain": exact(CALL_BACK),
        "torque_offset": exact(CALL_BACK),
        "time_delay": exact(f"{CALL_BACK}, which keeps the commands of the delay"),
        "load_dependent_friction": exact("VELOCITY_CONTROL, its force set at every step"),
        "torque_ripple": exact(CALL_BACK),
        "encoder_offset": exact("joint origin of model.urdf"),
        "joint_elasticity": approximate(
            f"a second joint behind the motor's, its spring in {CALL_BACK}",
            "where no rotor inertia is named the motor gets a twentieth of the inertia that it moves",
        ),
        "backlash": approximate(
            f"a second joint behind the motor's, its stops at ±h in {CALL_BACK}",
            "without a named rotor the motor gets a twentieth of what it moves",
        ),
        "presliding_hysteresis": exact(f"{CALL_BACK}, which keeps the bend of the bristles"),
        "saturation": exact(CALL_BACK),
        "coupled_transmission": exact(f"{CALL_BACK}, friction solved for the coupled motor"),
    }

    def write(self, arm: ArmPhysics, folder: Path) -> tuple[Path, ...]:
        path = folder / "model.urdf"
        write_xml(path, urdf_of(arm, bare=True))
        return (path, *write_runtime(arm, folder, "run_pybullet.py", "friction_impulse.py"))
