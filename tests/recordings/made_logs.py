"""Small logs of every foreign format, made here from known numbers."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from rosbags import rosbag1, rosbag2
from rosbags.rosbag2 import StoragePlugin
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from lagnet.recordings.readers.ros.definitions import DEFINITIONS

JOINTS = ("pan", "lift", "elbow", "wrist_1", "wrist_2", "wrist_3")
N, STEP = 120, 0.01
TIME = STEP * np.arange(N)
Q = np.sin(TIME[:, None] * (2 + np.arange(6))) * (0.5 + 0.1 * np.arange(6))
V = np.gradient(Q, TIME, axis=0)
TAU = 3 * Q + V
COMMAND = Q + 0.01
SECOND = 1_000_000_000
EPOCH = 1_700_000_000 * SECOND + 123


class BagWriter:
    """Writes messages into a bag of any kind."""

    def __init__(self, path: Path, kind: str = "db3", state_layout: int = 0):
        self.ros1 = kind == "bag"
        self.store: Any = get_typestore(Stores.ROS1_NOETIC if self.ros1 else Stores.LATEST)
        for name, texts in DEFINITIONS.items():
            text = texts[min(state_layout, len(texts) - 1)]
            known = get_types_from_msg(text, name)
            self.store.register({k: v for k, v in known.items() if k not in self.store.types})
        plugin = {"db3": StoragePlugin.SQLITE3, "mcap": StoragePlugin.MCAP}.get(kind)
        self.writer: Any = rosbag1.Writer(path) if self.ros1 else rosbag2.Writer(path, version=9, storage_plugin=plugin)
        self.writer.open()
        self.topics: dict[str, Any] = {}

    def type(self, name: str) -> Any:
        """The class of a message type."""
        return self.store.types[name]

    def header(self, stamp: int) -> Any:
        """A header of that time [ns]."""
        time = self.type("builtin_interfaces/msg/Time")(stamp // SECOND, stamp % SECOND)
        more = {"seq": 0} if self.ros1 else {}
        return self.type("std_msgs/msg/Header")(stamp=time, frame_id="", **more)

    def write(self, topic: str, kind: str, received: int, **fields: Any) -> None:
        """Add a message."""
        if topic not in self.topics:
            self.topics[topic] = self.writer.add_connection(topic, kind, typestore=self.store)
        message = self.type(kind)(**fields)
        encode = self.store.serialize_ros1 if self.ros1 else self.store.serialize_cdr
        self.writer.write(self.topics[topic], received, encode(message, kind))

    def joint_state(self, topic: str, stamp: int, names: list[str], *signals: Any, received: int | None = None) -> None:
        """Add a JointState with position, velocity, effort."""
        values = [np.array(s, dtype=np.float64) for s in (*signals, *[()] * (3 - len(signals)))]
        fields = {"name": names, "position": values[0], "velocity": values[1], "effort": values[2]}
        self.write(
            topic, "sensor_msgs/msg/JointState", received or stamp + 5_000_000, header=self.header(stamp), **fields
        )

    def point(self, q: Any, v: Any = (), after: float = 0.0) -> Any:
        """A trajectory point."""
        duration = self.type("builtin_interfaces/msg/Duration")(int(after), round(after % 1 * SECOND))
        blank = np.zeros(0)
        return self.type("trajectory_msgs/msg/JointTrajectoryPoint")(
            np.asarray(q, float), np.asarray(v, float), blank, blank, duration
        )

    def no_point(self) -> Any:
        """A point of joints of several degrees of freedom, of which there are none."""
        duration = self.type("builtin_interfaces/msg/Duration")(0, 0)
        return self.type("trajectory_msgs/msg/MultiDOFJointTrajectoryPoint")([], [], [], duration)

    def close(self) -> None:
        """Finish the file."""
        self.writer.close()


def stamps() -> list[int]:
    """Header stamps of the samples [ns]."""
    return [EPOCH + round(t * SECOND) for t in TIME]


def made_bag(folder: Path, kind: str) -> Path:
    """Joint states in changing order, and controller states with the command."""
    path = folder / ("run.bag" if kind == "bag" else f"bag_{kind}")
    bag = BagWriter(path, kind)
    order = list(range(6))
    for k, stamp in enumerate(stamps()):
        at = order if k % 2 == 0 else order[::-1]
        names = [JOINTS[j] for j in at]
        bag.joint_state("/joint_states", stamp, names, Q[k, at], V[k, at], TAU[k, at])
        bag.write(
            "/arm_controller/state",
            "control_msgs/msg/JointTrajectoryControllerState",
            stamp + 5_000_000,
            header=bag.header(stamp),
            joint_names=list(JOINTS),
            desired=bag.point(COMMAND[k]),
            actual=bag.point(Q[k]),
            error=bag.point(COMMAND[k] - Q[k]),
        )
    bag.close()
    return path


def bare(folder: Path, kind: str) -> Path:
    """The storage file of a bag alone, under a name that says nothing."""
    (file,) = made_bag(folder, kind).glob(f"*.{kind}")
    return file.rename(folder / "recorded")


def lerobot(folder: Path, version: str = "v2.1", names: Any = None, episodes: int = 1, **changes: Any) -> Path:
    """A LeRobot data set; every episode holds the same motion."""
    path = folder / "set"
    (path / "meta").mkdir(parents=True)
    (path / "data" / "chunk-000").mkdir(parents=True)
    names = list(JOINTS) if names is None else names
    feature = {"dtype": "float32", "shape": [6], "names": names}
    info = {"codebase_version": version, "fps": 100, "features": {"observation.state": feature, "action": feature}}
    (path / "meta" / "info.json").write_text(json.dumps(info | changes.get("info", {})))
    state, action = changes.get("state", Q), changes.get("action", COMMAND)
    tables = [
        pa.table(
            {
                "observation.state": pa.array(list(state)),
                "action": pa.array(list(action)),
                "timestamp": pa.array(changes.get("timestamp", TIME).astype(np.float32)),
                "frame_index": pa.array(np.arange(N)),
                "episode_index": pa.array(np.full(N, e)),
            }
        )
        for e in range(episodes)
    ]
    if version == "v3.0":
        pq.write_table(pa.concat_tables(tables), path / "data" / "chunk-000" / "file-000.parquet")
    else:
        for e, table in enumerate(tables):
            pq.write_table(table, path / "data" / "chunk-000" / f"episode_{e:06d}.parquet")
    return path


def motion_folder(folder: Path, torque: np.ndarray | None = None) -> Path:
    """An SO-101 motion."""
    path = folder / "swing"
    path.mkdir()
    (folder / "joint_list.txt").write_text("\n".join(JOINTS))

    def cell(row: np.ndarray) -> str:
        return '"' + json.dumps(row.tolist()) + '"'

    micro = 1e6 * TIME
    told = [f"CONTROL,{float(micro[k])!r},{cell(COMMAND[k])}" for k in range(N)]
    (path / "control.csv").write_text("\n".join(["type,timestamp,positions", *told]) + "\n")
    tau = np.abs(TAU) if torque is None else torque
    seen = [f"STATE_MOTOR,{float(micro[k])!r},{cell(Q[k])},{cell(V[k])},{cell(tau[k])}" for k in range(N)]
    header = "type,timestamp,positions,velocities,torques"
    (path / "state_motor.csv").write_text("\n".join([header, *seen]) + "\n")
    return path


def servo_bench(folder: Path, micro: bool = False, motor: str = "xl330") -> Path:
    """One servo on a bench."""
    unit = 1e6 if micro else 1.0
    load = np.round(100 * V[:, 0]).astype(int) % 65536
    entries = [
        {
            "timestamp": TIME[k] * unit,
            "position": Q[k, 0],
            "speed": V[k, 0],
            "goal_position": COMMAND[k, 0],
            "torque_enable": bool(k > 5),
            "temp": 30,
            "input_volts": 7.4,
            "load": int(load[k]),
        }
        for k in range(N)
    ]
    path = folder / "servo.json"
    path.write_text(json.dumps({"kp": 200, "motor": motor, "entries": entries}))
    return path


def rtde(folder: Path, separator: str = ",") -> Path:
    """A table of UR's RTDE client."""
    blocks = {"actual_q": Q, "actual_qd": V, "actual_current": TAU, "target_q": COMMAND, "target_moment": 5 * TAU}
    names = ["timestamp", *(f"{name}_{i}" for name in blocks for i in range(6))]
    rows = np.column_stack([TIME, *blocks.values()])
    text = [separator.join(names), *(separator.join(map(repr, row)) for row in rows.tolist())]
    path = folder / "robot_data.csv"
    path.write_text("\n".join(text) + "\n")
    return path


def libfranka(folder: Path) -> Path:
    """A log of logToCSV."""
    seven = {n: np.column_stack([x, x[:, :1]]) for n, x in (("q", Q), ("c", COMMAND), ("v", V), ("t", TAU))}
    blocks = {
        "state.q": seven["q"],
        "state.q_d": seven["c"],
        "state.dq": seven["v"],
        "state.dq_d": seven["v"],
        "state.tau_J": seven["t"],
        "state.tau_ext_hat_filtered": 0 * seven["t"],
        "cmd.tau_J_d": 0.5 * seven["t"],
    }
    names = ["time", "success_rate", *(f"{name}[{i}]" for name in blocks for i in range(7))]
    rows = np.column_stack([np.round(1000 * TIME), np.ones(N), *blocks.values()])
    text = [", ".join(names), *(",".join(map(repr, row)) for row in rows.tolist())]
    path = folder / "log.csv"
    path.write_text("\n".join(text) + "\n")
    return path


MAKERS: dict[str, Callable[[Path], Path]] = {
    "rosbag2 folder of sqlite": lambda folder: made_bag(folder, "db3"),
    "rosbag2 folder of mcap": lambda folder: made_bag(folder, "mcap"),
    "bare db3": lambda folder: bare(folder, "db3"),
    "bare mcap": lambda folder: bare(folder, "mcap"),
    "ROS 1 bag": lambda folder: made_bag(folder, "bag"),
    "LeRobot v2.0": lambda folder: lerobot(folder, "v2.0"),
    "LeRobot v2.1": lambda folder: lerobot(folder, "v2.1", [list(JOINTS)]),
    "LeRobot v3.0": lambda folder: lerobot(folder, "v3.0", {"motors": list(JOINTS)}),
    "motion folder": motion_folder,
    "servo bench": servo_bench,
    "RTDE with commas": rtde,
    "RTDE with spaces": lambda folder: rtde(folder, " "),
    "libfranka": libfranka,
}
HOLDS = {  # which signals each format carries here
    "rosbag": ("q", "v", "tau", "command"),
    "bare": ("q", "v", "tau", "command"),
    "ROS 1": ("q", "v", "tau", "command"),
    "LeRobot": ("q", "command"),
    "motion": ("q", "v", "command"),
    "servo": ("q", "v", "command", "enabled", "temperature", "voltage", "duty"),
    "RTDE": ("q", "v", "current", "command"),
    "libfranka": ("q", "v", "tau", "command", "command_velocity", "command_torque"),
}
EXPECTED = {"q": Q, "v": V, "tau": TAU, "command": COMMAND, "current": TAU}


def holds(maker: str) -> tuple[str, ...]:
    """Signals of a format."""
    return next(signals for start, signals in HOLDS.items() if maker.startswith(start))


def arm(joints: tuple[str, ...] = JOINTS) -> SimpleNamespace:
    """Anything with joints, in place of a robot."""
    return SimpleNamespace(joints=joints, n_dof=len(joints))
