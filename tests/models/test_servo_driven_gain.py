"""A servo-driven model at another gain moves as the model under a recording of that gain, saturation and all."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.models.corrected.servo_driven import ServoDrivenModel
from lagnet.rigid_body.random_arm import random_arm
from lagnet.servos.parameters import law_vector

ARM = random_arm(2, seed=3, kinds=("revolute",), fixed=False)


@pytest.mark.parametrize("gain", [0.4, 2.0])
@pytest.mark.parametrize("more", [{}, {"full_error": 0.05, "ki": 20.0}, {"torque_limit": 1.0, "dead_band": 0.01}])
def test_it_moves_as_under_that_gain(gain, more):
    laws = np.tile(law_vector(kp=30.0, kd=3.0, rotor=0.05, coulomb=0.2, **more), (2, 1))
    model, time = ServoDrivenModel(ARM, laws, (True, True)), np.arange(0.0, 2.0, 0.01)
    command = np.column_stack([0.6 * np.sin(2.0 * time), 0.4 * np.sign(np.sin(3.0 * time))])
    expected = model.rollout(command, time, np.zeros(2), gain=gain)
    assert np.abs(model.at_gain(gain).rollout(command, time, np.zeros(2)) - expected).max() < 1e-9
    assert np.abs(model.rollout(command, time, np.zeros(2)) - expected).max() > 1e-3
