"""Build a Drake plant from an exported model: gravity and springs that a URDF has no place for.

Needs Drake alone: `python run_drake.py` prints the arm's state after falling for a second.
"""

import json
import sys
from pathlib import Path

import numpy as np
from pydrake.all import (
    AddMultibodyPlantSceneGraph,
    DiagramBuilder,
    Parser,
    PdControllerGains,
    PrismaticJoint,
    PrismaticSpring,
    RevoluteSpring,
    Simulator,
)


def build(folder, step=0.001):
    """A diagram with the plant, finalised and welded to the world.

    Args:
        folder: where model.urdf and settings.json lie.
        step: [s] of the discrete plant; 0: continuous.

    Returns:
        The diagram builder and the plant.
    """
    folder = Path(folder)
    settings = json.loads((folder / "settings.json").read_text(encoding="utf-8"))
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, time_step=step)
    (arm,) = Parser(plant).AddModels(folder / "model.urdf")
    children = {plant.get_joint(i).child_body().name() for i in plant.GetJointIndices(arm)}
    base = next(b for b in map(plant.get_body, plant.GetBodyIndices(arm)) if b.name() not in children)
    plant.WeldFrames(plant.world_frame(), base.body_frame())
    plant.mutable_gravity_field().set_gravity_vector(np.array(settings["gravity"]))
    for name, stiffness, rest in zip(settings["joints"], settings["stiffness"], settings["spring_rest"], strict=True):
        if stiffness:
            joint = plant.GetJointByName(name, arm)
            slides = isinstance(joint, PrismaticJoint)
            plant.AddForceElement((PrismaticSpring if slides else RevoluteSpring)(joint, rest, stiffness))
    if "servo" in settings:  # position commands go into plant.get_desired_state_input_port(arm)
        law = settings["servo"]["law"]
        for name, kp, kd in zip(settings["joints"], law["kp"], law["kd"], strict=True):
            plant.GetJointActuatorByName(name, arm).set_controller_gains(PdControllerGains(p=kp, d=kd))
    plant.Finalize()
    return builder, plant


def main():
    """Let the arm fall for a second and print where it is."""
    builder, plant = build(Path(__file__).resolve().parent)
    diagram = builder.Build()
    simulator = Simulator(diagram)
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    plant.get_actuation_input_port().FixValue(context, np.zeros(plant.num_actuators()))
    simulator.AdvanceTo(1.0)
    print("after 1 s without torque:", plant.GetPositions(context))


if __name__ == "__main__":
    sys.exit(main())
