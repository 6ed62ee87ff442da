"""Tables recorded over the real-time data exchange (RTDE) of Universal Robots, separated by spaces or commas.

Source: Universal Robots, RTDE guide (names, units and meaning of the outputs).
"""

from __future__ import annotations

from lagnet.recordings.readers.logs.log_source import Origin
from lagnet.recordings.readers.logs.vocabulary import Vocabulary

UR_RTDE = Vocabulary(
    origin=Origin(
        "UR RTDE table", "its columns timestamp and actual_q_0 … actual_q_5", "the column timestamp", effort=""
    ),
    needed=("timestamp", *(f"actual_q_{i}" for i in range(6))),
    time=("timestamp", 1.0),
    signals={
        "q": ("actual_q_{i}",),
        "v": ("actual_qd_{i}",),
        "current": ("actual_current_{i}",),
        "tau": ("actual_current_as_torque_{i}",),
        "command": ("target_q_{i}",),
        "command_velocity": ("target_qd_{i}",),
        "temperature": ("joint_temperatures_{i}",),
        "voltage": ("actual_joint_voltage_{i}",),
    },
    joints=6,
    notes={
        r"target_moment_\d": "target_moment is the torque of the controller's own model, no measurement: not read",
        r"actual_current_as_torque_\d": "actual_current_as_torque is the motor current times the maker's constants",
    },
)
