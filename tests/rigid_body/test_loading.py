"""Named robots, real files, joint kinds, limits, and what callers may count on."""

from __future__ import annotations

import copy
import hashlib
import re
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from lagnet.errors import RobotError
from lagnet.rigid_body.descriptions.named_robots import HELD_JOINTS, named_robot_path, named_robots
from lagnet.rigid_body.inertia import is_physically_consistent, principal_moments
from lagnet.rigid_body.random_arm import random_arm
from lagnet.rigid_body.robot import load_description
from lagnet.types import InverseDynamics

ORACLE = 1e-8  # against Pinocchio called directly, relative to the largest torque

ARMS = {
    "ur3": 6, "ur5": 6, "ur10": 6, "ur5_gripper": 6, "panda": 7, "xarm7": 7, "kinova": 6, "z1": 6, "so100": 5,
    "so101": 5, "talos_arm": 6, "bravo7_gripper": 6, "bravo7_no_ee": 6, "double_pendulum": 2, "asr_twodof": 2,
    "finger_edu": 3, "double_pendulum_continuous": 2,
}  # fmt: skip


@pytest.mark.parametrize("name", ARMS)
def test_named_arms_load_and_match_pinocchio(name):
    robot = load_description(name)
    assert robot.n_dof == ARMS[name] == len(robot.joints) == len(robot.joint_types) == len(robot.links)
    assert (robot.kind, robot.source) == ("named_robot", name)
    assert isinstance(robot, InverseDynamics)
    assert is_physically_consistent(robot.inertial_parameters()).all()
    q, v, a = np.random.default_rng(0).normal(size=(3, 20, robot.n_dof))
    expected = torques_of_pinocchio(name, robot.joints, q, v, a)
    tau = robot.inverse_dynamics(q, v, a)
    assert np.abs(tau - expected).max() < ORACLE * np.abs(expected).max()


def torques_of_pinocchio(name, joints, q, v, a):
    """The whole file in Pinocchio itself, every other joint at rest at zero, continuous joints on the unit circle."""
    model = pin.buildModelFromUrdf(str(named_robot_path(name)))
    data, rows = model.createData(), []
    for i in range(len(q)):
        position, velocity, acceleration = pin.neutral(model), np.zeros(model.nv), np.zeros(model.nv)
        for k, joint in enumerate(joints):
            part = model.joints[model.getJointId(joint)]
            angle = q[i, k]
            position[part.idx_q : part.idx_q + part.nq] = angle if part.nq == 1 else [np.cos(angle), np.sin(angle)]
            velocity[part.idx_v], acceleration[part.idx_v] = v[i, k], a[i, k]
        tau = pin.rnea(model, data, position, velocity, acceleration)
        rows.append([tau[model.joints[model.getJointId(joint)].idx_v] for joint in joints])
    return np.array(rows)


def test_every_listed_robot_loads():
    for name in named_robots():
        assert load_description(name).n_dof >= 2, name


def test_ur3_is_a_ur3():
    # the collection's own table hands out the UR-5 under this name
    masses = load_description("ur3").inertial_parameters()[:, 0]
    assert masses == pytest.approx([2.0, 3.42, 1.26, 0.8, 0.8, 0.35])


def test_named_grippers_are_held_and_those_of_files_kept():
    assert load_description("panda").n_dof == 7
    whole = load_description(named_robot_path("panda"))
    assert whole.n_dof == 8, "both fingers follow one motion in the file"
    assert any("panda_finger_joint2 mimics panda_finger_joint1" in warning for warning in whole.warnings)
    for name, held in HELD_JOINTS.items():
        if name in named_robots():
            assert not set(held) & set(load_description(name).joints)


def test_real_robots_load(shared_data):
    ur10e = load_description(shared_data / "ur10e" / "ur10e.urdf")
    assert ur10e.n_dof == 6
    assert ur10e.sha256 == hashlib.sha256((shared_data / "ur10e" / "ur10e.urdf").read_bytes()).hexdigest()
    assert is_physically_consistent(ur10e.inertial_parameters()).all()
    emps = load_description(str(shared_data / "emps" / "emps.urdf"))
    assert (emps.joint_types, emps.kind) == (("prismatic",), "urdf")
    assert emps.mass_matrix(np.zeros((1, 1)))[0, 0, 0] == pytest.approx(95.0)
    tx40 = load_description(shared_data / "staubli_tx40" / "tx40.urdf")
    assert any("joint_6 feels no inertia" in warning for warning in tx40.warnings)


def test_raw_files_with_shapes_load(shared_data):
    for path in (
        shared_data / "ur10e" / "raw" / "ur10e.urdf",
        shared_data / "staubli_tx40" / "raw" / "tx40_mdh_modified.urdf",
    ):
        assert load_description(path).n_dof == 6


def test_limits_are_infinite_where_there_are_none():
    robot = load_description("kinova")
    assert robot.joint_types[0] == "continuous"
    assert robot.position_lower[0] == -np.inf
    assert robot.position_upper[0] == np.inf
    assert robot.velocity_limit[0] == pytest.approx(0.62831853)
    assert robot.effort_limit.shape == (6,)
    with pytest.raises(ValueError, match="read-only"):
        robot.position_lower[0] = 0.0


def test_continuous_joints_take_any_angle():
    robot = random_arm(4, 3, kinds=("continuous",))
    q, v, a = np.random.default_rng(0).normal(size=(3, 5, 4))
    turned = robot.inverse_dynamics(q + 2 * np.pi * np.array([3, -5, 100, 1]), v, a)
    assert np.allclose(turned, robot.inverse_dynamics(q, v, a), rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("name", ["ur55", "Panda", "pandas", "nothing_like_it"])
def test_unknown_names_show_the_choices(name):
    with pytest.raises(RobotError) as caught:
        load_description(name)
    assert "ur5" in caught.value.choices
    if name != "nothing_like_it":
        assert "did you mean" in str(caught.value)


def test_a_folder_of_the_same_name_does_not_hide_a_robot(tmp_path, monkeypatch):
    (tmp_path / "ur5").mkdir()
    (tmp_path / "mine").write_text(random_arm(2, 0)._description.file.text.decode())
    monkeypatch.chdir(tmp_path)
    assert load_description("ur5").kind == "named_robot"
    assert load_description("mine").kind == "urdf"


def test_floating_robots_are_refused_by_name():
    with pytest.raises(RobotError, match="floating base"):
        load_description("anymal")


def test_missing_files_and_folders_are_told(tmp_path):
    with pytest.raises(RobotError, match="No such file"):
        load_description(tmp_path / "absent.urdf")
    with pytest.raises(RobotError, match="folder"):
        load_description(tmp_path)


@pytest.mark.parametrize("shape", [(6,), (3, 5), (2, 3, 6), ()])
def test_wrong_shapes_are_told(shape):
    robot = load_description("ur5")
    with pytest.raises(ValueError, match=r"q has shape .* expected \((n_samples|\d+), 6\)"):
        robot.gravity_torque(np.zeros(shape))
    with pytest.raises(ValueError, match="a has shape"):
        robot.inverse_dynamics(np.zeros((3, 6)), np.zeros((3, 6)), np.zeros((2, 6)))


def test_no_samples_give_no_torques():
    robot, nothing = load_description("ur5"), np.zeros((0, 6))
    assert robot.inverse_dynamics(nothing, nothing, nothing).shape == (0, 6)
    assert robot.mass_matrix(nothing).shape == (0, 6, 6)
    assert robot.joint_torque_regressor(nothing, nothing, nothing).shape == (0, 6, 60)
    assert list(robot.regressor_chunks(nothing, nothing, nothing)) == []


def test_one_joint_arms_keep_their_axes():
    robot = random_arm(1, 0)
    q, v, a = np.random.default_rng(0).normal(size=(3, 4, 1))
    assert robot.joint_torque_regressor(q, v, a).shape == (4, 1, 10)
    assert robot.wrench_regressor(q).shape == (4, 1, 6)
    assert robot.coriolis_matrix(q, v).shape == (4, 1, 1)


def test_lists_and_single_precision_are_taken():
    robot = load_description("ur5")
    assert np.array_equal(robot.gravity_torque([[0.0] * 6]), robot.gravity_torque(np.zeros((1, 6), np.float32)))


def test_skeleton_runs_from_base_to_tip():
    robot = load_description("ur5")
    points, axes = robot.skeleton(np.zeros(6)), robot.joint_axes(np.zeros(6))
    assert points.shape == (8, 3)
    assert np.array_equal(points[0], [0, 0, 0])
    assert points[-1] == pytest.approx([0.81725, 0.19145, -0.005491], abs=1e-6)  # flange of the maker's drawing
    assert np.linalg.norm(axes, axis=1) == pytest.approx(np.ones(6))
    assert axes[0] == pytest.approx([0, 0, 1])
    with pytest.raises(ValueError, match="one pose"):
        robot.skeleton(np.zeros((1, 6)))


def test_a_payload_pushes_like_its_weight():
    robot, q = load_description("panda"), np.random.default_rng(0).normal(size=(5, 7))
    weight = robot.wrench_regressor(q, joint=6) @ np.array([0, 0, -2 * 9.81, 0, 0, 0])
    loaded = robot.with_payload(2.0, np.zeros(3), np.zeros((3, 3)))  # a point at the origin of the last joint
    assert np.abs(loaded.gravity_torque(q) - robot.gravity_torque(q) - weight).max() < 1e-9


def test_changes_that_make_no_sense_are_told():
    robot = load_description("ur5")
    with pytest.raises(ValueError, match=r"\(6, 10\)"):
        robot.with_inertial_parameters(np.zeros((5, 10)))
    with pytest.raises(ValueError, match="first moment"):
        robot.with_inertial_parameters(np.tile([0, 1.0, *[0] * 8], (6, 1)))
    with pytest.raises(ValueError, match=r"\(3,\)"):
        robot.with_gravity(np.array([9.81]))
    with pytest.raises(ValueError, match="com and inertia"):
        robot.with_payload(1.0, np.zeros(2), np.eye(3))
    with pytest.raises(ValueError, match="expected 0 to 5"):
        robot.link_regressor(6, *np.zeros((3, 1, 6)))


def test_copies_and_threads_give_the_same_torques():
    robot = load_description("panda")
    q, v, a = np.random.default_rng(0).normal(size=(3, 400, 7))
    expected = robot.inverse_dynamics(q, v, a)
    assert np.array_equal(copy.deepcopy(robot).inverse_dynamics(q, v, a), expected)
    with ThreadPoolExecutor(4) as pool:
        results = list(pool.map(lambda _: robot.inverse_dynamics(q, v, a), range(8)))
    assert all(np.array_equal(result, expected) for result in results)


def test_the_documented_table_is_what_loads():
    text = (Path(__file__).parents[2] / "docs" / "rigid_body.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `(\w+)` \| (\d+) \| ([\w, ]+) \|", text, flags=re.MULTILINE)
    assert [name for name, *_ in rows] == list(named_robots())
    for name, n_dof, kinds in rows:
        types = load_description(name).joint_types
        counts = [f"{types.count(k)} {k}" for k in ("revolute", "continuous", "prismatic") if k in types]
        assert (int(n_dof), kinds) == (len(types), ", ".join(counts)), name


def test_documented_links_break_the_triangle_and_no_moving_body_does():
    broken = dict(load_description("allegro_left_hand").link_inertials)["link_15.0"]
    assert principal_moments(broken) == pytest.approx([8.237e-6, 2.786e-5, 4.450e-5], rel=1e-3)
    assert not is_physically_consistent(broken, margin=-1e-9)
    for name in named_robots():
        assert is_physically_consistent(load_description(name).inertial_parameters()).all(), name
