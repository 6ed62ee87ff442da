"""Friction that changes over a recording is told with its size; friction that does not is not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lagnet.diagnosis.diagnose import diagnose

SAMPLE = 0.01  # [s]
FALL = 0.3  # of the friction, from start to end
NEAR = 0.05  # of the friction, to which the change must be right


@pytest.fixture(scope="module")
def warming():
    """A recording with Coulomb and viscous friction at the second joint that changes by a share over its time."""

    def added(recording, change: float):
        v = np.gradient(recording.q[:, 1], SAMPLE)
        level = 1.0 + change * (recording.time / recording.time[-1] - 0.5)
        tau = recording.tau.copy()
        tau[:, 1] += level * (4.0 * v + 3.0 * np.tanh(v / 1e-3))
        return replace(recording, tau=tau)

    return added


def test_friction_that_falls_is_told_by_how_much(plant, arm, warming, names) -> None:
    real = plant()
    recordings = [warming(real.record(seed), -FALL) for seed in (1, 2)]
    result = diagnose(recordings, arm, [warming(real.record(3), -FALL)])
    assert names(result) >= {("viscous_friction", arm.joints[1]), ("coulomb_friction", arm.joints[1])}
    told = [w for w in result.verdict.warnings if "friction falls" in w]
    assert len(told) == 2
    for line in told:
        assert line.startswith(arm.joints[1])
        assert float(line.split("falls by ")[1].split(" ")[0]) == pytest.approx(100.0 * FALL, abs=100.0 * NEAR)
    left = next(u for u in result.verdict.unexplained if u.joint == arm.joints[1])
    assert left.above_noise
    assert "time" in left.depends_on


def test_constant_friction_does_not_drift(plant, arm, warming) -> None:
    real = plant()
    recordings = [warming(real.record(seed), 0.0) for seed in (11, 12)]
    result = diagnose(recordings, arm, [warming(real.record(13), 0.0)])
    assert not any("friction" in warning for warning in result.verdict.warnings)
