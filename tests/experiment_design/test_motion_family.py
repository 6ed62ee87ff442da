"""Whatever the genes say, a motion begins and ends at rest and keeps its limits."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.experiment_design.motion_family import change_decision_vector, draw_decision_vector, motion_of
from lagnet.experiment_design.motion_limits import MotionLimits
from lagnet.recordings.conditioning.smoothing import derivative

RATE = 100.0  # [Hz]
AT_REST = 1e-3  # of the limit: a spline's derivative at its end
LIMITS = MotionLimits(
    lower=np.array([-1.0, 0.2, -0.05]),
    upper=np.array([2.0, 0.4, 0.05]),
    speed=np.array([1.0, 0.3, 0.1]),
    acceleration=np.array([3.0, 1.0, 0.5]),
    torque=np.full(3, 10.0),
    from_model=True,
)


@pytest.mark.parametrize("seed", range(8))
def test_limits_hold_for_drawn_and_changed_genes(seed: int) -> None:
    rng = np.random.default_rng(seed)
    genes = draw_decision_vector(3, rng)
    for g in (genes, change_decision_vector(genes, rng), np.round(genes)):
        motion = motion_of(g, LIMITS, RATE)
        assert LIMITS.allow(motion.q, motion.v, motion.a, np.zeros_like(motion.q))
        np.testing.assert_allclose(motion.v, derivative(motion.time, motion.q), atol=1e-9)
        assert np.all(np.abs(motion.v[[0, -1]]) <= AT_REST * LIMITS.speed)


def test_a_wider_motion_uses_what_it_is_allowed() -> None:
    motions = [motion_of(draw_decision_vector(3, np.random.default_rng(s)), LIMITS, RATE) for s in range(8)]
    used = np.max([np.abs(m.v).max(axis=0) / LIMITS.speed for m in motions], axis=0)
    assert np.all(used > 0.5)


def test_more_than_the_limits_is_not_allowed() -> None:
    motion = motion_of(draw_decision_vector(3, np.random.default_rng(0)), LIMITS, RATE)
    still = np.zeros_like(motion.q)
    for q, v, a, tau in (
        (motion.q + 5.0, motion.v, motion.a, still),
        (motion.q, 50.0 * motion.v, motion.a, still),
        (motion.q, motion.v, 50.0 * motion.a, still),
        (motion.q, motion.v, motion.a, still + 10.1),
    ):
        assert not LIMITS.allow(q, v, a, tau)
