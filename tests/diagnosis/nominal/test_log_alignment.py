"""Logs of the same commands find each other, whatever their clocks say; other motions do not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lagnet.diagnosis.nominal.log_alignment import lay_side_by_side

STEP = 0.01  # [s]


def later(recording, seconds):
    """The same motion, begun later after a rest, on a clock of its own."""
    n = round(seconds / STEP)
    q, tau = (np.concatenate([np.repeat(x[:1], n, axis=0), x]) for x in (recording.q, recording.tau))
    return replace(recording, time=5.0 + STEP * np.arange(len(q)), q=q, tau=tau)


def test_the_same_motion_is_laid_over_the_real_one(plant, arm, at) -> None:
    real, simulated = plant(at(1, lambda q, v, a, t: 4.0 * v)).record(1), later(plant().record(1), 1.37)
    (pair,) = lay_side_by_side([real], [plant().record(2), simulated])
    assert pair.lag == pytest.approx(5.0 + 1.37, abs=2 * STEP)
    difference = pair.tau_real - pair.tau_simulated
    v = np.gradient(real.q[:, 1], STEP)[: len(difference)]
    assert np.corrcoef(difference[:, 1], v)[0, 1] > 0.95
    assert np.std(difference[:, 0]) < 0.05 * np.std(pair.tau_real[:, 0])


def test_another_motion_is_laid_over_nothing(plant) -> None:
    assert lay_side_by_side([plant().record(1)], [plant().record(2), plant().record(3)]) == ()


def test_each_real_log_takes_the_nearest(plant) -> None:
    pairs = lay_side_by_side([plant().record(4), plant().record(5)], [plant().record(5), plant().record(4)])
    assert [round(p.lag, 2) for p in pairs] == [0.0, 0.0]
    assert all(np.std(p.tau_real - p.tau_simulated) < 0.02 * np.std(p.tau_real) for p in pairs)
