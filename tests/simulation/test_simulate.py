"""Recordings depend on settings and seed alone, show the sensors' faults, and never hold the truth."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lagnet.errors import LagnetError
from lagnet.rigid_body.robot import Robot
from lagnet.simulation.injection import inject
from lagnet.simulation.simulate import SimulationSettings, simulate

STATISTICAL = 4.0  # standard errors
GAIN, OFFSET, LATE = 1.2, 0.7, 0.004


def test_the_same_seed_gives_the_same_recordings(ur5: Robot, quick: SimulationSettings) -> None:
    short = replace(quick, motion=replace(quick.motion, duration=1.0))
    first, again = (simulate(ur5, (), short).recordings[0] for _ in range(2))
    other = simulate(ur5, (), replace(short, seed=1)).recordings[0]
    np.testing.assert_array_equal(first.q, again.q)
    np.testing.assert_array_equal(first.tau, again.tau)
    assert np.abs(first.q - other.q).max() > 0.01


def test_noise_encoder_and_clock_are_as_asked(ur5: Robot, quick: SimulationSettings) -> None:
    sensors = replace(quick.sensors, torque_noise=0.02, encoder_bits=12, clock_jitter=5e-4, records_velocity=True)
    noisy = simulate(ur5, (), replace(quick, sensors=sensors)).recordings[0]
    silent = replace(sensors, torque_noise=0.0, encoder_bits=0, velocity_noise=0.0)
    still = simulate(ur5, (), replace(quick, sensors=silent)).recordings[0]
    np.testing.assert_array_equal(noisy.time, still.time)
    assert np.all(np.diff(noisy.time) > 0)
    assert np.diff(noisy.time).std() > 1e-4
    grain = 2 * np.pi / 2**12
    assert np.abs(noisy.q / grain - np.round(noisy.q / grain)).max() < 1e-6
    assert np.abs(noisy.q - still.q).max() <= grain / 2 * (1 + 1e-9)
    share = (noisy.tau - still.tau).std(axis=0) / np.sqrt(np.mean(still.tau**2, axis=0))
    assert np.abs(share / 0.02 - 1).max() <= STATISTICAL / np.sqrt(2 * len(noisy))
    assert noisy.v is not None
    assert still.v is not None
    assert (noisy.v - still.v).std() == pytest.approx(sensors.velocity_noise, rel=0.1)


def test_gain_offset_and_delay_change_the_signal_and_not_the_motion(ur5: Robot, clean: SimulationSettings) -> None:
    joint = ur5.joints[2]
    effects = [
        inject(ur5, "torque_gain", joint, {"g": GAIN}),
        inject(ur5, "torque_offset", joint, {"b": OFFSET}),
        inject(ur5, "time_delay", joint, {"T": LATE}),
    ]
    true = simulate(ur5, (), clean).recordings[0]
    seen = simulate(ur5, effects, clean).recordings[0]
    np.testing.assert_array_equal(true.q, seen.q)
    late = round(LATE * clean.sensors.rate)
    np.testing.assert_allclose(seen.tau[late:, 2], GAIN * true.tau[:-late, 2] + OFFSET, atol=1e-9)
    np.testing.assert_array_equal(np.delete(true.tau, 2, axis=1), np.delete(seen.tau, 2, axis=1))


def test_the_truth_is_complete_and_apart_from_the_recordings(ur5: Robot, quick: SimulationSettings) -> None:
    short = replace(quick, motion=replace(quick.motion, duration=1.0))
    done = simulate(ur5, [inject(ur5, "viscous_friction", "elbow_joint", {"Fv": 2.0})], short)
    assert done.truth["effects"] == [{"effect": "viscous_friction", "joint": "elbow_joint", "parameters": {"Fv": 2.0}}]
    assert done.truth["settings"]["seed"] == short.seed
    recording = done.recordings[0]
    assert recording.path == ""
    assert recording.warnings == ()
    assert recording.trajectory_names == ("0",)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"engine": "chalk"}, "unknown engine 'chalk'.*pybullet"),
        ({"trajectories": 0}, "0 trajectories"),
        ({"seed": -1}, "seed is -1"),
        ({"shapes": ("waltz",)}, "unknown motions in waltz"),
    ],
)
def test_settings_that_make_no_sense_are_refused(
    ur5: Robot, quick: SimulationSettings, change: dict, message: str
) -> None:
    with pytest.raises(LagnetError, match=message):
        simulate(ur5, (), replace(quick, **change))
