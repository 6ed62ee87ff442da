"""Names and units of what a recording may hold of each joint: the columns of the recording contract."""

from __future__ import annotations

UNITS = {
    "q": "rad",
    "v": "rad/s",
    "a": "rad/s²",
    "tau": "N m",
    "current": "A",
    "command": "rad",
    "command_velocity": "rad/s",
    "command_torque": "N m",
    "enabled": "0 or 1",
    "temperature": "°C",
    "voltage": "V",
    "duty": "1",
}
JOINT_SIGNALS = tuple(UNITS)
DRIVE_SIGNALS = JOINT_SIGNALS[5:]  # what the joint was told, and the state of its drive
OPTIONAL = ("v", "a", "current", *DRIVE_SIGNALS)  # a recording is complete without them
DRIVING = ("tau", "current", "command")  # a recording needs one of them: else nothing says what moved the arm


def kind_of(column: str) -> str | None:
    """The signal that a column such as `command_velocity_3` or a bare `q` belongs to, or None."""
    fitting = [
        kind for kind in JOINT_SIGNALS if column == kind or (column.startswith(f"{kind}_") and column != f"{kind}_")
    ]
    return max(fitting, key=len, default=None)
