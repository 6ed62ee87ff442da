"""What is written parses again by the libraries of the formats, with the values of the corrected model."""

from __future__ import annotations

import ast
from pathlib import Path

import mujoco
import numpy as np
import pinocchio as pin
import pytest

from lagnet.models.corrected.model import CorrectedModel, NamedEffect
from lagnet.rigid_body.random_arm import random_arm
from lagnet.simulators.corrected_arm.arm_physics import ArmPhysics, arm_physics
from lagnet.simulators.engines.registry import engine_of
from lagnet.simulators.registry import EXPORTERS
from lagnet.simulators.runtime.run_mujoco import CorrectedArm as MujocoArm

POSES = np.random.default_rng(4).uniform(-1.0, 1.0, (4, 3))
DEGREE = 180.0 / np.pi


def bodies(physics: ArmPhysics) -> tuple[np.ndarray, np.ndarray]:
    """Mass matrix with rotors, and gravity torque, where encoders give the poses."""
    true = POSES + physics.shift
    return physics.robot.mass_matrix(true) + np.diag(physics.rotor), physics.robot.gravity_torque(true)


def written(name: str, physics: ArmPhysics, folder: Path) -> Path:
    return EXPORTERS[name].write(physics, folder)[0]


def test_mjcf_holds_bodies_rotors_and_friction(physics: ArmPhysics, tmp_path: Path) -> None:
    written("mjcf", physics, tmp_path)
    arm = MujocoArm(tmp_path)
    M, gravity = bodies(physics)
    for pose, inertia, weight in zip(POSES, M, gravity, strict=True):
        arm.put(pose, np.zeros(3))
        full = np.zeros((3, 3))
        mujoco.mj_fullM(arm.model, arm.data, full)
        np.testing.assert_allclose(full, inertia, rtol=1e-6, atol=1e-8)
        np.testing.assert_allclose(arm.data.qfrc_bias, weight, rtol=1e-6, atol=1e-7)
    np.testing.assert_allclose(arm.model.dof_armature, physics.rotor)
    np.testing.assert_allclose(arm.model.dof_damping, physics.viscous)
    np.testing.assert_allclose(arm.model.dof_frictionloss, [0.0, 0.6, 0.8])
    np.testing.assert_allclose(arm.model.jnt_stiffness, physics.stiffness)


def test_mjcf_holds_spring_and_damper_of_a_flexible_joint(tmp_path: Path) -> None:
    effects = (NamedEffect("joint_elasticity", 1, {"K": 90.0, "D": 0.7}), NamedEffect("rotor_inertia", 1, {"Ia": 0.1}))
    bare = random_arm(3, seed=5, kinds=("revolute",))
    written("mjcf", arm_physics(CorrectedModel(bare, effects, np.full(3, 0.01))), tmp_path)
    arm = MujocoArm(tmp_path)
    link = next(j for j in range(arm.model.njnt) if arm.model.jnt_stiffness[j] > 0.0)
    np.testing.assert_allclose(arm.model.jnt_stiffness[link], 90.0)
    np.testing.assert_allclose(arm.model.dof_damping[arm.model.jnt_dofadr[link]], 0.7)


def test_urdf_holds_bodies_and_the_mounting(physics: ArmPhysics, tmp_path: Path) -> None:
    model = pin.buildModelFromUrdf(str(written("urdf", physics, tmp_path)))
    data = model.createData()
    M, gravity = bodies(physics)
    for pose, inertia, weight in zip(POSES, M, gravity, strict=True):
        found = pin.crba(model, data, pose)
        np.testing.assert_allclose(np.triu(found), np.triu(inertia - np.diag(physics.rotor)), rtol=1e-9, atol=1e-10)
        np.testing.assert_allclose(pin.computeGeneralizedGravity(model, data, pose), weight, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(model.damping, physics.viscous)


@pytest.mark.parametrize(("name", "rotors"), [("sdf", False), ("drake", True)])
def test_drake_reads_the_bodies(name: str, rotors: bool, physics: ArmPhysics, tmp_path: Path) -> None:
    from pydrake.all import MultibodyPlant, Parser

    path = written(name, physics, tmp_path)
    if rotors:
        from lagnet.simulators.runtime.run_drake import build

        builder, plant = build(tmp_path)
        builder.Build()
    else:
        plant = MultibodyPlant(0.001)
        Parser(plant).AddModels(str(path))
        plant.Finalize()
    context = plant.CreateDefaultContext()
    order = [plant.GetJointByName(j).position_start() for j in physics.robot.joints]
    M, gravity = bodies(physics)
    for pose, inertia, weight in zip(POSES, M, gravity, strict=True):
        q = np.zeros(3)
        q[order] = pose
        plant.SetPositions(context, q)
        found = plant.CalcMassMatrixViaInverseDynamics(context)[np.ix_(order, order)]
        expected = inertia if rotors else inertia - np.diag(physics.rotor)
        np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-10)
        np.testing.assert_allclose(-plant.CalcGravityGeneralizedForces(context)[order], weight, rtol=1e-9, atol=1e-9)
    damping = [plant.GetJointByName(j).default_damping() for j in physics.robot.joints]
    np.testing.assert_allclose(damping, physics.viscous)


def test_drake_has_the_spring_and_the_limit(physics: ArmPhysics, tmp_path: Path) -> None:
    from pydrake.all import MultibodyForces

    from lagnet.simulators.runtime.run_drake import build

    written("drake", physics, tmp_path)
    _, plant = build(tmp_path)
    context, forces = plant.CreateDefaultContext(), MultibodyForces(plant)
    at = plant.GetJointByName(physics.robot.joints[2]).position_start()
    plant.SetPositions(context, np.eye(3)[at] * 0.5)
    plant.CalcForceElementsContribution(context, forces)
    assert forces.generalized_forces()[at] == pytest.approx(-3.0 * (0.5 - 0.3))
    assert plant.GetJointActuatorByName(physics.robot.joints[1]).effort_limit() == pytest.approx(2.0)


def test_usd_counts_angles_in_degrees(physics: ArmPhysics, tmp_path: Path) -> None:
    from pxr import Gf, Usd, UsdGeom, UsdPhysics

    stage = Usd.Stage.Open(str(written("usd", physics, tmp_path)))
    scene = UsdPhysics.Scene(stage.GetPrimAtPath("/World/Scene"))
    gravity = np.array(scene.GetGravityDirectionAttr().Get()) * scene.GetGravityMagnitudeAttr().Get()
    np.testing.assert_allclose(gravity, physics.robot.gravity, rtol=1e-6, atol=1e-6)
    for j, body in enumerate(physics.robot.body_tree()):
        prim = stage.GetPrimAtPath(f"/World/Arm/{body.name}")
        mass = UsdPhysics.MassAPI(prim)
        assert mass.GetMassAttr().Get() == pytest.approx(body.mass, rel=1e-6)
        turn = np.array(Gf.Matrix3d(Gf.Rotation(Gf.Quatd(mass.GetPrincipalAxesAttr().Get())))).T
        tensor = turn @ np.diag(mass.GetDiagonalInertiaAttr().Get()) @ turn.T
        np.testing.assert_allclose(tensor, body.inertia, rtol=1e-4, atol=1e-7)
        joint = stage.GetPrimAtPath(f"/World/Arm/joint_{body.joint}")
        assert UsdPhysics.RevoluteJoint(joint).GetLowerLimitAttr().Get() == pytest.approx(body.lower * DEGREE, rel=1e-5)
        viscous = joint.GetAttribute("physxJointAxis:angular:viscousFrictionCoefficient").Get()
        assert viscous * DEGREE == pytest.approx(physics.viscous[j], rel=1e-6, abs=1e-9)
        assert joint.GetAttribute("newton:damping").Get() == pytest.approx(viscous, abs=1e-12)
        assert joint.GetAttribute("newton:armature").Get() == pytest.approx(physics.rotor[j], rel=1e-6)
        _frames_meet(stage, joint, UsdGeom, UsdPhysics, Gf)
    last = stage.GetPrimAtPath(f"/World/Arm/joint_{physics.robot.joints[2]}")
    efforts = [last.GetAttribute(f"physxJointAxis:angular:{k}FrictionEffort").Get() for k in ("static", "dynamic")]
    assert efforts == pytest.approx([0.8, 0.4])
    drive = UsdPhysics.DriveAPI(last, "angular")
    assert drive.GetStiffnessAttr().Get() * DEGREE == pytest.approx(3.0)
    assert drive.GetTargetPositionAttr().Get() / DEGREE == pytest.approx(0.3)


def _frames_meet(stage, joint, UsdGeom, UsdPhysics, Gf) -> None:
    """Both frames of a joint lie in one place while encoders stand at zero."""
    at, typed = UsdGeom.XformCache(), UsdPhysics.Joint(joint)
    frames = []
    for end in "01":
        (body,) = getattr(typed, f"GetBody{end}Rel")().GetTargets()
        local = Gf.Matrix4d()
        local.SetRotateOnly(Gf.Quatd(getattr(typed, f"GetLocalRot{end}Attr")().Get()))
        local.SetTranslateOnly(Gf.Vec3d(getattr(typed, f"GetLocalPos{end}Attr")().Get()))
        frames.append(np.array(local * at.GetLocalToWorldTransform(stage.GetPrimAtPath(body))))
    np.testing.assert_allclose(frames[0], frames[1], atol=1e-6)


def test_isaac_lab_settings_hold_the_values(physics: ArmPhysics, tmp_path: Path) -> None:
    tree = ast.parse(written("isaaclab", physics, tmp_path).read_text(encoding="utf-8"))
    settings = next(
        ast.literal_eval(n.value) for n in tree.body if isinstance(n, ast.Assign) and n.targets[0].id == "SETTINGS"
    )
    first, second, third = (settings[j]["values"] for j in physics.robot.joints)
    assert (first["viscous_friction"], first["armature"]) == (0.8, 0.15)
    assert second["effort_limit_sim"] == pytest.approx(2.0)
    assert (third["friction"], third["dynamic_friction"]) == pytest.approx((0.8, 0.4))
    assert (tmp_path / "model.usda").is_file()


def test_a_late_read_out_of_torque_is_late_in_mujoco(tmp_path: Path, corrected: CorrectedModel) -> None:
    from lagnet.simulators.corrected_arm.arm_physics import arm_physics
    from lagnet.simulators.round_trips.round_trip import case_of, control_of

    robot = corrected.nominal
    arm = arm_physics(case_of(robot, "time_delay", 1, T=0.02))
    EXPORTERS["mjcf"].write(arm, tmp_path)
    engine = engine_of("mjcf", "mujoco", tmp_path, robot.joints)
    control, shown = control_of(robot, 1.5), []
    engine.put(control.q[0], control.v[0])
    _, sent = control.run(engine, lambda k: shown.append(engine.late_torque(robot.joints[1])))
    np.testing.assert_allclose(np.array(shown)[100:], sent[100 - 20 : -20, 1], atol=2e-3 * np.abs(sent[:, 1]).max())
