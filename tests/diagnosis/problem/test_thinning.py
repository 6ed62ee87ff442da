"""Recordings sampled far beyond the band of the diagnosis are posed at a rate that the band needs."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from lagnet.diagnosis.problem.problem import Problem, pose_problem
from lagnet.diagnosis.problem.thinning import FULL_RATE, LONG_RATE, thinned
from lagnet.recordings.conditioning.condition import condition
from lagnet.recordings.recording import Recording

BANDWIDTH = 2.5  # [Hz]
FASTER = 10  # times the rate of the plant's recordings


@pytest.fixture(scope="module")
def oversampled(plant, at) -> list[Recording]:
    """Two recordings at 1 kHz."""
    real = plant(at(1, lambda q, v, a, tau: 3.0 * v))
    return [_faster(real.record(seed)) for seed in (1, 2)]


def _faster(recording: Recording) -> Recording:
    time = np.arange(FASTER * (recording.time.size - 1)) * (recording.time[1] - recording.time[0]) / FASTER
    q, tau = (CubicSpline(recording.time, x)(time) for x in (recording.q, recording.torque))
    return Recording(time, q, tau, recording.joints)


def _posed(arm, recordings, monkeypatch, limit: float) -> Problem:
    monkeypatch.setattr("lagnet.diagnosis.problem.thinning.FULL_RATE", limit)
    parts = [condition([r], BANDWIDTH) for r in recordings]
    return pose_problem(arm, *parts)


def test_the_rate_follows_the_band(arm, oversampled, monkeypatch) -> None:
    posed = _posed(arm, oversampled, monkeypatch, FULL_RATE)
    assert posed.rate == pytest.approx(FULL_RATE * BANDWIDTH)
    assert np.diff(posed.fit[0].time) == pytest.approx(1.0 / posed.rate)


def test_long_recordings_have_half_the_rate_and_held_out_ones_follow(arm, oversampled, monkeypatch) -> None:
    first = oversampled[0]
    held = [first.rows(slice(0, len(first) // 2))]  # short of what is long
    monkeypatch.setattr("lagnet.diagnosis.problem.thinning.LONG", 0.9 * len(first) * FULL_RATE * BANDWIDTH / first.rate)
    fit = condition([first], BANDWIDTH)
    posed = pose_problem(arm, fit, condition(held, BANDWIDTH))
    assert posed.rate == pytest.approx(LONG_RATE * BANDWIDTH)
    assert np.diff(posed.holdout[0].time) == pytest.approx(1.0 / posed.rate)


def test_residuals_are_those_of_all_samples(arm, oversampled, monkeypatch) -> None:
    few, all_of_them = (_posed(arm, oversampled, monkeypatch, limit) for limit in (FULL_RATE, np.inf))
    assert all_of_them.rate == pytest.approx(FASTER * 100.0)
    there, here = all_of_them.fit[0], few.fit[0]
    truth = all_of_them.residual(there)
    error = few.residual(here) - CubicSpline(there.time[there.keep], truth)(here.time[here.keep])
    inside = slice(20, -20)
    assert np.sqrt(np.mean(error[inside] ** 2, axis=0)) == pytest.approx(0.0, abs=0.01 * np.std(truth))


def test_what_is_sampled_as_needed_stays_as_it_is(plant) -> None:
    conditioned = condition([plant().record(3)], 10.0)
    assert thinned(conditioned) is conditioned
