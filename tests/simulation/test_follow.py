"""An arm that is sent along a motion goes along it, and shows what was injected."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lagnet.errors import LagnetError
from lagnet.rigid_body.robot import Robot
from lagnet.simulation.follow import at_rate, follow
from lagnet.simulation.injection import inject
from lagnet.simulation.simulate import SimulationSettings

RATE = 100.0  # [Hz] of the wanted motion
TRACKING = 1e-3  # [rad]: computed torque of the true bodies leaves less
SPLINE = 1e-5  # relative, of second derivatives of a quintic spline at 100 samples a period
LAW = 2e-3  # of the torque: the engine's law acts within a step of a millisecond


def swing(n_dof: int, seconds: float = 3.0) -> tuple[np.ndarray, np.ndarray]:
    """All joints there and back once, from rest to rest."""
    time = np.arange(round(seconds * RATE)) / RATE
    s = time / time[-1]
    return time, 0.2 * (np.sin(np.pi * s) ** 4)[:, None] * np.ones(n_dof)


def test_derivatives_are_those_of_the_positions() -> None:
    time = np.arange(300) / RATE
    moved = at_rate(time, np.sin(2 * np.pi * time)[:, None], 1000.0)
    inside = slice(100, -100)
    wanted = -((2 * np.pi) ** 2) * np.sin(2 * np.pi * moved.time)
    np.testing.assert_allclose(moved.a[inside, 0], wanted[inside], atol=SPLINE * (2 * np.pi) ** 2)


def test_the_arm_goes_where_it_is_sent(ur5: Robot, clean: SimulationSettings) -> None:
    time, q = swing(6)
    run = follow(ur5, (), time, q, replace(clean, sensors=replace(clean.sensors, rate=RATE)))
    np.testing.assert_allclose(run.q[: len(q)], q[: len(run.q)], atol=TRACKING)


def test_an_injected_law_acts_along_the_way(ur5: Robot, clean: SimulationSettings) -> None:
    time, q = swing(6)
    effects = [
        inject(ur5, "torque_offset", ur5.joints[2], {"b": 3.0}),
        inject(ur5, "torque_gain", ur5.joints[1], {"g": 1.1}),
    ]
    without, with_it = (follow(ur5, e, time, q, clean) for e in ((), effects))
    np.testing.assert_allclose(with_it.tau[:, 2] - without.tau[:, 2], 3.0, atol=LAW)
    np.testing.assert_allclose(with_it.tau[:, 1], 1.1 * without.tau[:, 1], rtol=LAW)


def test_a_motion_of_other_joints_is_refused(ur5: Robot) -> None:
    with pytest.raises(LagnetError, match="2 joints"):
        follow(ur5, (), *swing(2))


def test_too_short_a_motion_is_refused(ur5: Robot) -> None:
    with pytest.raises(LagnetError, match="5 samples"):
        follow(ur5, (), np.arange(5) / RATE, np.zeros((5, 6)))
