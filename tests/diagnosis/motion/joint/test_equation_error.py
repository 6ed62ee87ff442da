"""The first law of a joint, from motion that the equation error describes exactly."""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.motion.joint.equation_error import first_law
from lagnet.rollout.one_joint import JointSeries
from lagnet.servos.command_delay import command_integral
from lagnet.servos.parameters import INDEX

KP, DAMPING, BIAS = 4.0, 0.5, 0.03


def test_gains_of_the_recordings_are_no_part_of_the_law():
    time = np.arange(0.0, 60.0, 0.01)
    q, speed = np.sin(time) + 0.5 * np.sin(2.3 * time), np.cos(time) + 1.15 * np.cos(2.3 * time)
    acceleration = -np.sin(time) - 0.5 * 2.3**2 * np.sin(2.3 * time)
    gain, load = np.where(time < 30.0, 1.0, 8.0), 0.8 * np.sin(q)
    command = q + BIAS + (load + 0.01 * acceleration + DAMPING * speed) / (KP * gain)
    ones = np.ones_like(time)
    rows = (time, command, command_integral(time, command), q, 0.01 * ones, load, 0.0 * ones, ones, gain, ones)
    found = first_law(JointSeries(*rows), speed, acceleration, np.abs(speed) > 0.01, 1.0)
    assert found.scale_is_set
    assert found.scale_is_likely
    assert abs(found.law[INDEX["kp"]] / KP - 1.0) < 0.02
    assert abs(found.law[INDEX["viscous"]] / DAMPING - 1.0) < 0.02
    assert abs(found.law[INDEX["bias"]] - BIAS) < 0.003
