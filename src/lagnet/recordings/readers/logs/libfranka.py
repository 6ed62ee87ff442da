"""Logs that libfranka writes with `logToCSV`: time in milliseconds, torques of the link-side sensors.

Source: libfranka, `franka::logToCSV` and `franka::RobotState`.
"""

from __future__ import annotations

from lagnet.recordings.readers.logs.log_source import Origin
from lagnet.recordings.readers.logs.vocabulary import Vocabulary

LIBFRANKA = Vocabulary(
    origin=Origin(
        "libfranka log",
        "its columns success_rate, state.q[0] and state.tau_J[0]",
        "the column time, in milliseconds of the robot's clock",
        effort="state.tau_J, torque of the link-side sensors",
    ),
    needed=("time", "success_rate", "state.q[0]", "state.tau_J[0]"),
    time=("time", 1e-3),
    signals={
        "q": ("state.q[{i}]",),
        "v": ("state.dq[{i}]",),
        "tau": ("state.tau_J[{i}]",),
        "command": ("state.q_d[{i}]",),
        "command_velocity": ("state.dq_d[{i}]",),
        "command_torque": ("cmd.tau_J_d[{i}]",),
    },
    joints=7,
)
