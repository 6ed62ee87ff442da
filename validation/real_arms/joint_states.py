"""Joint states of a rosbag2 file (sqlite), read by hand: names, times, positions, speeds and efforts."""

from __future__ import annotations

import sqlite3
import struct
from pathlib import Path

import numpy as np

from lagnet.recordings.recording import Recording


def read_joint_states(path: Path, joints: tuple[str, ...]) -> Recording:
    """The recording in a bag of one topic of `sensor_msgs/JointState`, doubled stamps left out."""
    with sqlite3.connect(f"file:{path}?mode=ro", uri=True) as base:
        rows = [_message(blob) for (blob,) in base.execute("select data from messages order by timestamp")]
    order = [rows[0][1].index(joint) for joint in joints]
    time = np.array([row[0] for row in rows])
    q, v, effort = (np.array([row[k] for row in rows])[:, order] for k in (2, 3, 4))
    keep = np.concatenate([[True], np.diff(time) > 0])
    return Recording((time - time[0])[keep], q[keep], effort[keep], joints, v=v[keep], path=path.name)


def _message(blob: bytes) -> tuple:
    """Stamp, names and three arrays of a little-endian CDR message."""
    body = blob[4:]
    seconds, nanoseconds, size = struct.unpack_from("<iII", body, 0)
    place = 12 + size
    place += -place % 4
    (count,) = struct.unpack_from("<I", body, place)
    place, names = place + 4, []
    for _ in range(count):
        place += -place % 4
        (size,) = struct.unpack_from("<I", body, place)
        names.append(body[place + 4 : place + 3 + size].decode())
        place += 4 + size
    arrays = []
    for _ in range(3):
        place += -place % 4
        (size,) = struct.unpack_from("<I", body, place)
        place += 4
        place += -place % 8
        arrays.append(np.frombuffer(body, "<f8", size, place))
        place += 8 * size
    return seconds + 1e-9 * nanoseconds, names, *arrays
