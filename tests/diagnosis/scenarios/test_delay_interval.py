"""The interval of a delay knows that stamps of torque and motion differ by convention."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from lagnet.diagnosis.diagnose import diagnose
from lagnet.effects.signal.time_delay import CLOCK
from lagnet.recordings.recording import Recording

LATE = 0.03  # [s]


def late(recording: Recording, joint: int) -> Recording:
    tau = np.array(recording.tau)
    tau[:, joint] = CubicSpline(recording.time, tau[:, joint])(np.clip(recording.time - LATE, 0.0, None))
    return Recording(recording.time, recording.q, tau, recording.joints)


def test_a_delay_is_told_no_sharper_than_stamps_are(plant, arm) -> None:
    real = plant()
    result = diagnose([late(real.record(1), 1), late(real.record(2), 1)], arm, [late(real.record(3), 1)])
    (delay,) = (e for e in result.effects if e.effect == "time_delay")
    (t,) = delay.parameters
    assert t.value == pytest.approx(LATE, abs=CLOCK)
    low, high = t.ci95
    assert low < LATE < high
    assert high - low >= 2.0 * CLOCK
