"""Arms and short settings that the simulation tests share."""

from __future__ import annotations

import pytest

pytest.importorskip("pybullet")

from lagnet.rigid_body.robot import Robot, load_description
from lagnet.simulation.motions import MotionSettings
from lagnet.simulation.sensors import SensorSettings
from lagnet.simulation.simulate import SimulationSettings

QUICK = MotionSettings(duration=3.0)
CLEAN = SensorSettings(torque_noise=0.0, encoder_bits=0)


@pytest.fixture(scope="session")
def ur5() -> Robot:
    """Six revolute joints, light wrist."""
    return load_description("ur5")


@pytest.fixture
def quick() -> SimulationSettings:
    """One short recording with the usual noise."""
    return SimulationSettings(trajectories=1, motion=QUICK)


@pytest.fixture
def clean() -> SimulationSettings:
    """One short recording without noise or encoder steps, at the engine's own rate."""
    sensors = SensorSettings(rate=1000.0, torque_noise=0.0, encoder_bits=0)
    return SimulationSettings(trajectories=1, motion=QUICK, sensors=sensors)
