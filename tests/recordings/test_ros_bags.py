"""What ROS bags hold: stamps, publishers, names, and the ways in which commands are sent."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from tests.recordings.made_logs import COMMAND, JOINTS, TAU, TIME, BagWriter, N, Q, V, made_bag, stamps

from lagnet.errors import RecordingError
from lagnet.recordings.loading.load import load_recording
from lagnet.recordings.readers.ros.commands import followers

STATE = "control_msgs/msg/JointTrajectoryControllerState"


def states(bag: BagWriter, **signals: bool) -> None:
    """Joint states of all joints."""
    for k, stamp in enumerate(stamps()):
        bag.joint_state("/joint_states", stamp, list(JOINTS), Q[k], V[k], TAU[k])


def test_header_stamps_go_before_times_of_arrival(tmp_path: Path) -> None:
    bag, late = BagWriter(tmp_path / "bag"), np.random.default_rng(0).integers(0, 8_000_000, N)
    for k, stamp in enumerate(stamps()):
        bag.joint_state("/joint_states", stamp, list(JOINTS), Q[k], (), TAU[k], received=stamp + int(late[k]))
    bag.close()
    found = load_recording(tmp_path / "bag")
    np.testing.assert_allclose(found.time, TIME, atol=1e-12)
    assert found.warnings == ()
    assert found.v is None


def test_without_header_stamps_times_of_arrival_are_used_and_told(tmp_path: Path) -> None:
    bag = BagWriter(tmp_path / "bag")
    for k, stamp in enumerate(stamps()):
        bag.joint_state("/joint_states", 0, list(JOINTS), Q[k], V[k], TAU[k], received=stamp)
    bag.close()
    found = load_recording(tmp_path / "bag")
    np.testing.assert_allclose(found.time, TIME, atol=1e-12)
    assert found.warnings == ("/joint_states has no header stamps: times of arrival were used",)


def test_messages_that_come_late_are_sorted(tmp_path: Path) -> None:
    bag, order = BagWriter(tmp_path / "bag"), np.arange(N)
    order[[40, 41]] = order[[41, 40]]
    for at, k in enumerate(order):
        bag.joint_state("/joint_states", stamps()[k], list(JOINTS), Q[k], V[k], TAU[k], received=stamps()[at])
    bag.close()
    found = load_recording(tmp_path / "bag")
    np.testing.assert_array_equal(found.q, Q)
    assert found.warnings == ("1 messages on /joint_states came late and were sorted by their stamps",)


def test_several_publishers_and_partial_names(tmp_path: Path) -> None:
    """An arm and a gripper share a topic; a second topic repeats the arm without effort."""
    bag = BagWriter(tmp_path / "bag")
    for k, stamp in enumerate(stamps()):
        bag.joint_state("/joint_states", stamp, list(JOINTS[:4]), Q[k, :4], V[k, :4], TAU[k, :4])
        if k % 2 == 0:
            bag.joint_state("/joint_states", stamp + 2_000_000, list(JOINTS[4:]), Q[k, 4:], V[k, 4:], TAU[k, 4:])
        bag.joint_state("/arm/joint_states", stamp, list(JOINTS[:4]), Q[k, :4])
    bag.close()
    found = load_recording(tmp_path / "bag", joints=JOINTS)
    np.testing.assert_array_equal(found.q[:, :4], Q[:, :4])
    np.testing.assert_array_equal(found.tau[:, :4], TAU[:, :4])
    inside = slice(2, N - 2)
    np.testing.assert_allclose(found.q[inside, 4:], Q[inside, 4:], atol=0.02)
    assert found.warnings == (
        "/arm/joint_states repeats joints of /joint_states and was not read",
        "joints wrist_2, wrist_3 come from other messages (/joint_states): interpolated to the clock",
    )


def test_a_joint_without_effort_is_no_reason_to_refuse_the_others(tmp_path: Path) -> None:
    bag = BagWriter(tmp_path / "bag")
    for k, stamp in enumerate(stamps()):
        effort = TAU[k].copy()
        effort[5] = np.nan
        bag.joint_state("/joint_states", stamp, list(JOINTS), Q[k], V[k], effort)
    bag.close()
    np.testing.assert_array_equal(load_recording(tmp_path / "bag", joints=JOINTS[:5]).tau, TAU[:, :5])
    with pytest.raises(RecordingError, match=r"tau_5 \(or tau_wrist_3\) is missing"):
        load_recording(tmp_path / "bag")


@pytest.mark.parametrize("layout", [1, 2], ids=["new names", "new and old names"])
@pytest.mark.parametrize("kind", ["db3", "mcap", "db3 without layouts"])
def test_controller_states_with_the_new_field_names(kind: str, layout: int, tmp_path: Path) -> None:
    bag = BagWriter(tmp_path / "bag", kind.split()[0], layout)
    for k, stamp in enumerate(stamps()):
        points = {"reference": bag.point(COMMAND[k], V[k]), "feedback": bag.point(Q[k])}
        points |= {"error": bag.point(COMMAND[k] - Q[k]), "output": bag.point([])}
        if layout == 2:
            points |= {"desired": bag.point([]), "actual": bag.point([])}
        several = {f"multi_dof_{name}": bag.no_point() for name in points} | {"multi_dof_joint_names": []}
        head = bag.header(stamp)
        bag.write("/c/state", STATE, stamp, header=head, joint_names=list(JOINTS), **points, **several)
    bag.close()
    path = tmp_path / "bag"
    found = load_recording(forget_layouts(path) if "without" in kind else path)
    assert found.signals == ("q", "command", "command_velocity")
    np.testing.assert_array_equal(found.q, Q)
    np.testing.assert_array_equal(found.command, COMMAND)


def forget_layouts(folder: Path) -> Path:
    """The bag as an older recorder writes it: without the layouts of its messages."""
    import sqlite3

    (file,) = folder.glob("*.db3")
    base = sqlite3.connect(file)
    base.execute("UPDATE message_definitions SET encoded_message_definition = ''")
    base.commit()
    base.close()
    return file


@pytest.mark.parametrize("splined", [True, False])
def test_trajectories_become_commands(splined: bool, tmp_path: Path) -> None:
    bag = BagWriter(tmp_path / "bag")
    states(bag)
    times = np.array([0.2, 0.5, 0.8])
    goal = np.stack([np.full(6, g) for g in (0.2, -0.1, 0.4)])
    speed = np.stack([np.full(6, g) for g in (1.0, 0.0, 0.0)])
    points = [bag.point(g, s if splined else (), t) for g, s, t in zip(goal, speed, times, strict=True)]
    start = stamps()[10]
    name = "trajectory_msgs/msg/JointTrajectory"
    bag.write("/c/joint_trajectory", name, start, header=bag.header(start), joint_names=list(JOINTS), points=points)
    bag.close()
    found = load_recording(tmp_path / "bag")
    assert found.warnings == (
        "commands were interpolated between the points of 1 trajectory",
        "10 samples before the first command were left out",
    )
    np.testing.assert_allclose(found.command[[20, 50]], goal[:2], atol=1e-9)
    np.testing.assert_allclose(found.command[80:], 0.4, atol=1e-9)
    np.testing.assert_allclose(found.command[0], Q[10], atol=1e-9)
    if splined:
        np.testing.assert_allclose(found.command_velocity[20], 1.0, atol=1e-9)
    else:
        np.testing.assert_allclose(found.command[35], 0.05, atol=1e-9)
        np.testing.assert_allclose(found.command_velocity[30], -1.0, atol=1e-9)


def test_dynamic_joint_states(tmp_path: Path) -> None:
    bag = BagWriter(tmp_path / "bag")
    value = bag.type("control_msgs/msg/InterfaceValue")
    for k, stamp in enumerate(stamps()):
        values = [value(["effort", "position"], np.array([TAU[k, j], Q[k, j]])) for j in range(6)]
        bag.write(
            "/dynamic_joint_states",
            "control_msgs/msg/DynamicJointState",
            stamp,
            header=bag.header(stamp),
            joint_names=list(JOINTS),
            interface_values=values,
        )
    bag.close()
    found = load_recording(tmp_path / "bag")
    assert found.signals == ("q", "tau")
    np.testing.assert_array_equal(found.tau, TAU)


def test_arrays_without_names_go_to_the_joints_that_follow_them(tmp_path: Path) -> None:
    bag = BagWriter(tmp_path / "bag")
    states(bag)
    order = [2, 0, 1, 5, 3, 4]
    layout = bag.type("std_msgs/msg/MultiArrayLayout")([], 0)
    for k, stamp in enumerate(stamps()):
        bag.write(
            "/forward_position_controller/commands",
            "std_msgs/msg/Float64MultiArray",
            stamp + 5_000_000,
            layout=layout,
            data=COMMAND[k, order],
        )
    bag.close()
    found = load_recording(tmp_path / "bag")
    np.testing.assert_allclose(found.command[1:], COMMAND[1:], atol=1e-12)
    assert any("assigned to the joints that follow it (elbow, pan, lift, wrist_3" in w for w in found.warnings)


def test_arrays_that_no_joint_follows_are_not_commands() -> None:
    rng = np.random.default_rng(0)
    assert followers(rng.standard_normal((N, 6)), Q) is None
    assert followers(Q[:, [1, 0, 2, 3, 4, 5]], Q) == [1, 0, 2, 3, 4, 5]
    still = np.zeros_like(Q)
    still[:, 0] = Q[:, 0]
    assert followers(still + 1e-3, still) == [0, 1, 2, 3, 4, 5]


def test_commands_on_a_topic_of_joint_states(tmp_path: Path) -> None:
    bag = BagWriter(tmp_path / "bag")
    for k, stamp in enumerate(stamps()):
        bag.joint_state("/joint_states", stamp, list(JOINTS), Q[k], V[k], TAU[k])
        bag.joint_state("/joint_command", stamp, list(JOINTS[::-1]), COMMAND[k, ::-1])
    bag.close()
    np.testing.assert_array_equal(load_recording(tmp_path / "bag").command, COMMAND)


def test_a_bag_without_joint_states_says_what_it_holds(tmp_path: Path) -> None:
    bag = BagWriter(tmp_path / "bag")
    bag.write("/chatter", "std_msgs/msg/String", stamps()[0], data="hello")
    bag.close()
    with pytest.raises(RecordingError, match=r"has no joint states: it holds /chatter \(std_msgs/msg/String\)"):
        load_recording(tmp_path / "bag")


def test_progress_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bag = BagWriter(tmp_path / "bag")
    states(bag)
    bag.close()
    monkeypatch.setattr("lagnet.recordings.readers.ros.bag_files.EVERY", 50)
    told: list[tuple[int, int | None]] = []
    load_recording(tmp_path / "bag", progress=lambda name, done, total: told.append((done, total)))
    assert told == [(50, N), (100, N), (N, N)]


def test_a_bag_that_another_library_wrote(tmp_path: Path) -> None:
    from mcap_ros2.writer import Writer

    layout = (
        "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n"
        + "=" * 80
        + "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
        + "=" * 80
        + "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
    )
    path = tmp_path / "other.mcap"
    with path.open("wb") as stream:
        writer = Writer(stream)
        schema = writer.register_msgdef("sensor_msgs/msg/JointState", layout)
        for k, stamp in enumerate(stamps()):
            time = {"sec": stamp // 10**9, "nanosec": stamp % 10**9}
            message = {
                "header": {"stamp": time, "frame_id": ""},
                "name": list(JOINTS),
                "position": Q[k].tolist(),
                "velocity": V[k].tolist(),
                "effort": TAU[k].tolist(),
            }
            writer.write_message("/joint_states", schema, message, stamp, stamp)
        writer.finish()
    bag = BagWriter(tmp_path / "bag", "mcap")
    states(bag)
    bag.close()
    left, right = load_recording(path), load_recording(tmp_path / "bag")
    for name in ("time", "q", "v", "tau"):
        np.testing.assert_array_equal(getattr(left, name), getattr(right, name))
    assert left.joints == right.joints == JOINTS


def test_a_number_of_messages_that_is_none_breaks_nothing(tmp_path: Path) -> None:
    path = made_bag(tmp_path, "db3")
    metadata = path / "metadata.yaml"
    text = metadata.read_text()
    metadata.write_text(re.sub(r"message_count: 120\b", "message_count: many", text))
    assert metadata.read_text() != text
    np.testing.assert_array_equal(load_recording(path, joints=JOINTS).q, Q)
