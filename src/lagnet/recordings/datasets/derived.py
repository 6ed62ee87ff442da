"""Turns upstream files of public data sets into recordings and robots of ours, each by a stated transformation."""

from __future__ import annotations

import gzip
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import scipy.io

UR10E_RUNS = {
    "fit_0": "ur-20_02_10-30sec_12harm",
    "fit_1": "ur-20_02_12-40sec_12harm",
    "fit_2": "ur-20_02_12-50sec_12harm",
    "fit_3": "ur-20_02_19_14harm50sec",
    "holdout": "ur-20_02_19_15harm50sec",
}
# [N m/A], current to joint torque, from the identification of the authors of the data.
UR10E_TORQUE_CONSTANTS = (14.87, 13.26, 11.13, 10.62, 11.03, 11.47)
TX40_RATE, TX40_DECIMATION, TX40_FIT_ROWS = 5000.0, 5, 6000
EMPS_FORCE, EMPS_FIT_ROWS = "gtau", 16000
EMPS_URDF = """<robot name="emps">
  <link name="base"/>
  <link name="carriage"><inertial><origin xyz="0 0 0"/><mass value="95.0"/>\
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="carriage"/><axis xyz="1 0 0"/>\
<limit lower="-0.5" upper="0.5" effort="1000" velocity="2"/></joint>
</robot>
"""


@dataclass(frozen=True)
class Recipe:
    """How one file is made.

    Args:
        needs: files of the same data set that it is made from.
        make: paths of those files to the content of the new one.
    """

    needs: tuple[str, ...]
    make: Callable[[Sequence[Path]], bytes]

    def write(self, target: Path, sources: Sequence[Path]) -> Path:
        """Make the file; it appears whole or not at all."""
        content = self.make(sources)
        target.parent.mkdir(parents=True, exist_ok=True)
        part = target.with_name(f".{target.name}.{os.getpid()}.part")
        try:
            part.write_bytes(content)
            part.replace(target)
        finally:
            part.unlink(missing_ok=True)
        return target


def ur10e_run(sources: Sequence[Path]) -> bytes:
    """Columns time, q, v and motor current of the raw table (0, 1-6, 7-12, 13-18), time from 0."""
    raw = np.loadtxt(sources[0], delimiter=",", usecols=range(19))
    raw[:, 0] -= raw[0, 0]
    names = ["time", *(f"{kind}_{i}" for kind in ("q", "v", "current") for i in range(6))]
    return _csv_gz(names, raw)


def ur10e_columns(_sources: Sequence[Path]) -> bytes:
    """A mapping file that holds the torque constants, for `--columns`."""
    values = ", ".join(f"{value:g}" for value in UR10E_TORQUE_CONSTANTS)
    return f"# N m per ampere at the joint, from the identification of the authors of the data\n\
[torque_constant]\nvalues = [{values}]\n".encode()


def tx40_run(part: slice) -> Callable[[Sequence[Path]], bytes]:
    """Joint positions and torques from motor positions and currents, 5 kHz to 1 kHz through a zero-phase filter.

    q = R⁻¹ q_motor with R = diag(32, 32, 45, -48, 45, 32), R[5, 4] = 32, then q_1 - π/2 and q_2 + π/2;
    tau = K current with K = diag(32, 32, 45, -48, 45, 32), K[4, 5] = 32: the wrist is coupled.
    """

    def make(sources: Sequence[Path]) -> bytes:
        from scipy.signal import decimate

        position, current = (np.loadtxt(path, delimiter=",", skiprows=1) for path in sources)
        gear = np.diag([32.0, 32.0, 45.0, -48.0, 45.0, 32.0])
        motion, torque = gear.copy(), gear.copy()
        motion[5, 4], torque[4, 5] = 32.0, 32.0
        q = np.linalg.solve(motion, position.T).T + np.array([0, -np.pi / 2, np.pi / 2, 0, 0, 0])
        signals = decimate(np.hstack([q, current @ torque.T]), TX40_DECIMATION, ftype="fir", axis=0, zero_phase=True)
        time = np.arange(len(signals)) * TX40_DECIMATION / TX40_RATE
        names = ["time", *(f"{kind}_{i}" for kind in ("q", "tau") for i in range(6))]
        return _csv_gz(names, np.column_stack([time, signals])[part])

    return make


def emps_run(part: slice) -> Callable[[Sequence[Path]], bytes]:
    """Position and force = gtau · vir [N/V · V]."""

    def make(sources: Sequence[Path]) -> bytes:
        raw = scipy.io.loadmat(sources[0], variable_names=["t", "qm", "vir", EMPS_FORCE])
        force = float(raw[EMPS_FORCE].item()) * raw["vir"][:, 0]
        return _csv_gz(["time", "q_0", "tau_0"], np.column_stack([raw["t"][:, 0], raw["qm"][:, 0], force])[part])

    return make


def rigid_bodies(sources: Sequence[Path]) -> bytes:
    """The links and joints of a URDF without pictures, collision shapes and simulator settings."""
    robot = ElementTree.parse(sources[0]).getroot()
    for element in list(robot):
        if element.tag not in ("link", "joint"):
            robot.remove(element)
        for shape in [child for child in element if child.tag in ("visual", "collision")]:
            element.remove(shape)
    ElementTree.indent(robot)
    return ElementTree.tostring(robot) + b"\n"


def _csv_gz(names: Sequence[str], rows: np.ndarray) -> bytes:
    lines = [",".join(names), *(",".join(f"{value:.7g}" for value in row) for row in rows)]
    return gzip.compress(("\n".join(lines) + "\n").encode(), mtime=0)


TX40_RAW = ("raw/pos_read_data.csv", "raw/curr_data.csv")
EMPS_RAW = ("raw/DATA_EMPS.mat",)
RECIPES: dict[str, dict[str, Recipe]] = {
    "ur10e": {
        **{f"{run}.csv.gz": Recipe((f"raw/{raw}.csv",), ur10e_run) for run, raw in UR10E_RUNS.items()},
        "ur10e.urdf": Recipe(("raw/ur10e.urdf",), rigid_bodies),
        "columns.toml": Recipe((), ur10e_columns),
    },
    "staubli_tx40": {
        "fit.csv.gz": Recipe(TX40_RAW, tx40_run(slice(0, TX40_FIT_ROWS))),
        "holdout.csv.gz": Recipe(TX40_RAW, tx40_run(slice(TX40_FIT_ROWS, None))),
        "tx40.urdf": Recipe(("raw/tx40_mdh_modified.urdf",), rigid_bodies),
    },
    "emps": {
        "fit.csv.gz": Recipe(EMPS_RAW, emps_run(slice(0, EMPS_FIT_ROWS))),
        "holdout.csv.gz": Recipe(EMPS_RAW, emps_run(slice(EMPS_FIT_ROWS, None))),
        "emps.urdf": Recipe((), lambda _sources: EMPS_URDF.encode()),
    },
}
