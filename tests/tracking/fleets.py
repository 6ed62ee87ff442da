"""Small recordings of a two-joint arm whose friction, load and sensor scale are known."""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path

import numpy as np

import lagnet
from lagnet.recordings.recording import Recording
from lagnet.recordings.writing import write_recording
from lagnet.tracking.statistics.series import Observation

URDF = """<robot name="planar"><link name="base"/>
<link name="upper"><inertial><origin xyz="0.18 0 0"/><mass value="2.4"/>
<inertia ixx="0.004" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.03"/></inertial></link>
<link name="fore"><inertial><origin xyz="0.15 0 0"/><mass value="1.3"/>
<inertia ixx="0.002" ixy="0" ixz="0" iyy="0.014" iyz="0" izz="0.014"/></inertial></link>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/>
<limit lower="-2.8" upper="2.8" effort="60" velocity="6"/></joint>
<joint name="elbow" type="revolute"><origin xyz="0.4 0 0"/><parent link="upper"/><child link="fore"/>
<axis xyz="0 1 0"/><limit lower="-2.8" upper="2.8" effort="30" velocity="6"/></joint></robot>"""
VISCOUS, DRY = np.array([1.0, 0.5]), np.array([1.2, 0.6])
START = datetime(2026, 1, 5)


def write_arm(folder: Path) -> Path:
    """The nominal model."""
    path = folder / "planar.urdf"
    path.write_text(URDF)
    return path


def record(arm: Path, seed: int, friction: float = 1.0, tool: float = 0.0, seconds: float = 12.0) -> Recording:
    """Another motion for each seed; a tool is a point mass at 0.3 m."""
    rng, robot = np.random.default_rng(seed), lagnet.load_robot(str(arm))
    time = np.arange(int(100 * seconds)) / 100.0
    omega = 2.0 * np.pi * rng.uniform(0.1, 0.9, (5, 2))
    size, phase = rng.uniform(0.1, 0.3, (5, 2)), rng.uniform(0.0, 6.28, (5, 2))
    angle = omega * time[:, None, None] + phase
    q, v = (size * np.sin(angle)).sum(axis=1), (size * omega * np.cos(angle)).sum(axis=1)
    a = -(size * omega**2 * np.sin(angle)).sum(axis=1)
    bodies = robot.inertial_parameters().copy()
    bodies[-1] += tool * np.array([1.0, 0.3, 0, 0, 0, 0, 0.09, 0, 0, 0.09])
    tau = robot.with_inertial_parameters(bodies).inverse_dynamics(q, v, a)
    tau = tau + friction * (VISCOUS * v + DRY * np.tanh(v / 0.01)) + 0.03 * rng.standard_normal(q.shape)
    return Recording(time, q + 2e-5 * rng.standard_normal(q.shape), tau, robot.joints)


def write_fleet(folder: Path, robots: int, recordings: int, calibrated: bool = True) -> Path:
    """A manifest with robots of which the first has a tool in its last recording."""
    arm = write_arm(folder)
    lines = ["[settings]", "reports = false", "[[make]]", 'name = "planar"', 'robot = "planar.urdf"']
    if calibrated:
        write_recording(record(arm, 999), folder / "calibration.parquet")
        lines.append('calibration = "calibration.parquet"')
    for r in range(robots):
        lines += ["[[robot]]", f'name = "arm_{r}"', "[[robot.recordings]]", f'files = "arm_{r}/*.parquet"']
        lines += ['date_in_name = "%Y-%m-%d"', "temperature = 25"]
        for k in range(recordings):
            tool = 0.4 if r == 0 and k == recordings - 1 else 0.0
            name = f"{START + timedelta(days=7 * k):%Y-%m-%d}.parquet"
            write_recording(record(arm, 100 * r + k, tool=tool), folder / f"arm_{r}" / name)
    (folder / "fleet.toml").write_text("\n".join(lines) + "\n")
    return folder / "fleet.toml"


def observations(
    robot: str,
    values: np.ndarray,
    temperature: np.ndarray | None = None,
    half: float = 0.02,
    parameter: tuple[str, str, str | None] = ("coulomb_friction", "Fc", "elbow"),
) -> list[Observation]:
    """A parameter in weekly recordings, with relative half intervals."""
    effect, name, joint = parameter
    warm = np.full(values.size, 25.0) if temperature is None else temperature
    return [
        Observation(
            robot,
            "planar",
            joint,
            effect,
            name,
            "N m",
            float(x),
            float(x - half * abs(x)),
            float(x + half * abs(x)),
            START + timedelta(days=7 * k),
            float(warm[k]),
            2.0,
            f"{robot}/{k}",
        )
        for k, x in enumerate(values)
    ]
