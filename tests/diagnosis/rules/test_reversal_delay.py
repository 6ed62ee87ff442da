"""Friction that turns round before the speed does is no delay; a delay beside friction is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from lagnet.diagnosis.diagnose import diagnose

JOINT = 1
LEAD = 0.012  # [s] by which dry friction turns before the speed


@pytest.fixture
def rubbing(plant, at):
    """A plant with dry friction that turns some time before the speed does."""

    def of(lead: float):
        size = plant().usual_torque()[JOINT]
        return replace(plant(at(JOINT, lambda q, v, a, body: size * np.tanh((v + lead * a) / 0.05))), noise=0.001)

    return of


def test_friction_that_turns_early_is_friction_alone(rubbing, arm, names) -> None:
    real = rubbing(LEAD)
    result = diagnose([real.record(seed) for seed in (1, 2, 3)], arm, [real.record(4)])
    assert names(result) == {("coulomb_friction", arm.joints[JOINT])}


def test_a_delay_beside_friction_keeps_its_name(rubbing, arm, names) -> None:
    real = rubbing(0.0)

    def late(seed: int):
        one = real.record(seed)
        tau = np.array(one.tau)
        tau[:, JOINT] = CubicSpline(one.time, tau[:, JOINT])(np.maximum(one.time - 2.0 * LEAD, 0.0))
        return replace(one, tau=tau)

    result = diagnose([late(seed) for seed in (1, 2, 3)], arm, [late(4)])
    assert names(result) == {("coulomb_friction", arm.joints[JOINT]), ("time_delay", arm.joints[JOINT])}
