"""Writes bags of two gigabytes, joint states among camera pictures, and measures how they are read.

python -m validation.big_bag.study [--quick]
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

HERE = Path(__file__).resolve().parent
JOINTS = [f"joint_{j}" for j in range(1, 7)]
RATE, PICTURE = 500, 1_000_000  # [Hz] of joint states; bytes of a picture, of which there are five a second
LIMIT = 1e9  # bytes of memory
BEGIN = 1_700_000_000_000_000_000  # [ns]
PLUGINS = {"db3": StoragePlugin.SQLITE3, "mcap": StoragePlugin.MCAP}


def write_bag(folder: Path, kind: str, size: float) -> None:
    """A bag of about `size` bytes: joint states of six joints with stamps, and pictures of random bytes."""
    store: Any = get_typestore(Stores.LATEST)
    state, header, stamp = (
        store.types[name]
        for name in ("sensor_msgs/msg/JointState", "std_msgs/msg/Header", "builtin_interfaces/msg/Time")
    )
    picture, every = np.random.default_rng(0).bytes(PICTURE), RATE // 5
    count = int(size / (PICTURE / every + 300))
    turns = np.arange(1, len(JOINTS) + 1)
    with Writer(folder, version=9, storage_plugin=PLUGINS[kind]) as bag:
        joints = bag.add_connection("/joint_states", "sensor_msgs/msg/JointState", typestore=store)
        camera = bag.add_connection("/camera", "sensor_msgs/msg/CompressedImage", typestore=store)
        for k in range(count):
            at, phase = BEGIN + k * (1_000_000_000 // RATE), turns * k / RATE
            now = header(stamp=stamp(at // 1_000_000_000, at % 1_000_000_000), frame_id="")
            message = state(now, JOINTS, np.sin(phase), turns * np.cos(phase), np.cos(phase))
            bag.write(joints, at, store.serialize_cdr(message, "sensor_msgs/msg/JointState"))
            if k % every == 0:
                bag.write(camera, at, picture)


def measured(folder: Path) -> dict[str, Any]:
    """Seconds and largest memory [bytes] of `lagnet data inspect`."""
    words = [sys.executable, "-m", "lagnet", "data", "inspect", str(folder)]
    begun = time.perf_counter()
    pid = os.fork()
    if pid == 0:
        os.chdir(folder.parent)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        os.execv(sys.executable, words)
    _, status, usage = os.wait4(pid, 0)
    return {
        "seconds": round(time.perf_counter() - begun, 1),
        "memory_bytes": usage.ru_maxrss * 1024,
        "code": os.waitstatus_to_exitcode(status),
    }


def main() -> None:
    """Both kinds of bag; writes result.json. --quick: twenty megabytes, nothing written."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true")
    size = 2e7 if parser.parse_args().quick else 2e9
    results = {}
    for kind in PLUGINS:
        with tempfile.TemporaryDirectory() as scratch:
            folder = Path(scratch) / "bag"
            write_bag(folder, kind, size)
            whole = sum(f.stat().st_size for f in folder.iterdir())
            results[kind] = {"bag_bytes": whole, **measured(folder)}
        print(kind, results[kind], flush=True)
        assert results[kind]["code"] == 0
        assert results[kind]["memory_bytes"] <= LIMIT
    if size >= 2e9:
        (HERE / "result.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
