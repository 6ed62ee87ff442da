"""Physics in nobody's catalogue gets no name, whatever law happens to follow it on the fitted motion."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.diagnose import diagnose

pytestmark = pytest.mark.slow

SHOULDER, WRIST = 1, 2
SIZE = 0.15  # of the joint's torque


def cable(joint: int, size: float, onset: float):
    """A line that goes taut at one angle of a joint, and harder a little further on."""

    def law(q, v, a, t):
        out = np.zeros_like(q)
        pull = np.maximum(q[:, joint] - onset, 0.0) + 2.0 * np.maximum(q[:, joint] - onset - 0.3, 0.0)
        out[:, joint] = size * pull
        return out

    return law


@pytest.mark.parametrize("joint", [SHOULDER, WRIST])
def test_a_line_that_goes_taut_is_no_push_and_no_link(joint: int, plant, arm, names) -> None:
    probe = plant(lambda q, v, a, t: np.zeros_like(q)).record(1)
    onset = float(np.quantile(probe.q[:, joint], 0.7))
    real = plant(cable(joint, 4.0 * SIZE * float(np.std(probe.tau[:, joint])), onset))
    result = diagnose([real.record(1), real.record(2)], arm, [real.record(3)])
    found = {name for name, _ in names(result)}
    assert not found & {"contact_force", "link_inertia", "payload"}
    left = next(u for u in result.verdict.unexplained if u.joint == arm.joints[joint])
    assert found or (left.above_noise and f"q_{joint}" in left.depends_on)


def test_what_only_the_fitted_motion_shows_is_still_told(plant, arm) -> None:
    quiet = plant(lambda q, v, a, t: np.zeros_like(q))
    probe = quiet.record(1)
    onset = float(np.quantile(probe.q[:, WRIST], 0.6))
    real = plant(cable(WRIST, 6.0 * SIZE * float(np.std(probe.tau[:, WRIST])), onset))
    result = diagnose([real.record(1), real.record(2)], arm, [quiet.record(3)])
    left = next(u for u in result.verdict.unexplained if u.joint == arm.joints[WRIST])
    assert left.above_noise
    assert left.share_of_mismatch > 0.5
    assert all(f.nmse_named < 1.5 * max(f.nmse_nominal, f.nmse_noise_floor) for f in result.verdict.fit)
