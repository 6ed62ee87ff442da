"""Layouts of the messages that are read, for bags that do not state them (Source: sensor_msgs, control_msgs)."""

from __future__ import annotations

JOINT_STATE = "sensor_msgs/msg/JointState"
TRAJECTORY = "trajectory_msgs/msg/JointTrajectory"
CONTROLLER_STATE = "control_msgs/msg/JointTrajectoryControllerState"
DYNAMIC_STATE = "control_msgs/msg/DynamicJointState"
ARRAY = "std_msgs/msg/Float64MultiArray"

_POINT = "trajectory_msgs/JointTrajectoryPoint"
_START = "std_msgs/Header header\nstring[] joint_names\n"


def _state(*points: str, several: bool = True) -> str:
    """Layout of a controller's state; the newer ones repeat every point for joints of several degrees of freedom."""
    more = "".join(f"trajectory_msgs/MultiDOFJointTrajectoryPoint multi_dof_{name}\n" for name in points)
    one = "".join(f"{_POINT} {name}\n" for name in points)
    return _START + one + ("string[] multi_dof_joint_names\n" + more if several else "")


# Per type the layouts that were published, in the order in which they are tried.
DEFINITIONS = {
    JOINT_STATE: ("std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n",),
    TRAJECTORY: (f"{_START}{_POINT}[] points\n",),
    CONTROLLER_STATE: (
        _state("desired", "actual", "error", several=False),
        _state("reference", "feedback", "error", "output"),
        _state("reference", "feedback", "error", "output", "desired", "actual"),
    ),
    DYNAMIC_STATE: (
        f"{_START}control_msgs/InterfaceValue[] interface_values\n"
        + "=" * 80
        + "\nMSG: control_msgs/InterfaceValue\nstring[] interface_names\nfloat64[] values\n",
    ),
    ARRAY: ("std_msgs/MultiArrayLayout layout\nfloat64[] data\n",),
}
