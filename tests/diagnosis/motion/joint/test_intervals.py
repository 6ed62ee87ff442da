"""Intervals of a law's parameters where the encoder errs to one side."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lagnet.diagnosis.motion.joint.fitting import JointData, fit_law, free_coordinates
from lagnet.diagnosis.motion.joint.intervals import law_intervals
from lagnet.rollout.one_joint import JointSeries, Windows
from lagnet.servos.command_delay import command_integral
from lagnet.servos.parameters import law_vector

ONE_SIDED = 4e-4  # [rad] by which every position is read too low
TRUE = law_vector(kp=20.0, viscous=2.0, rotor=0.01, bias=0.03)


def test_an_encoder_that_errs_to_one_side_is_covered_by_its_resolution():
    time = np.arange(0.0, 12.0, 0.02)
    command, ones, zeros = np.sin(1.3 * time), np.ones_like(time), np.zeros_like(time)
    rows = (time, command, command_integral(time, command), zeros, 0.01 * ones, zeros, zeros, ones, ones, ones)
    first = np.arange(0, 600, 100)
    windows = Windows(first, first + 99, np.zeros(6, dtype=int), np.zeros(6))
    whole = Windows(np.array([0]), np.array([599]), np.array([0]), np.zeros(1))
    real = JointData(JointSeries(*rows), whole, 0.002).predict(TRUE[None])[0] - ONE_SIDED
    windows = replace(windows, speed=np.gradient(real, time)[first])
    data = JointData(replace(JointSeries(*rows), q=real), windows, 0.002)
    coordinates = free_coordinates([("bias",)], TRUE, {"bias": 0.01})
    law = fit_law(data, TRUE, coordinates, scale=1e-3).law
    narrow, wide = (law_intervals(data, law, coordinates, 1e-3, r)["bias"] for r in (0.0, 4.0 * ONE_SIDED))
    assert not narrow[0] <= 0.03 <= narrow[1]
    assert wide[0] <= 0.03 <= wide[1]
