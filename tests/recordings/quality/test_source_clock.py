"""The source's clock is found where a log reads, passes over or stamps samples at its own times, and nowhere else."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lagnet.recordings.quality.screen import screen
from lagnet.recordings.quality.source_clock import source_clock
from lagnet.recordings.recording import Recording

STEP = 0.02  # [s] of the log
JOINTS = ("shoulder", "elbow", "wrist")


def motion(seed: int):
    """Position over time of three joints, sums of sines of up to .8 Hz."""
    rng = np.random.default_rng(seed)
    omega, phase = rng.uniform(0.7, 5.0, (4, 3)), rng.uniform(0, 6.3, (4, 3))
    return lambda t: np.sum(0.4 * np.sin(omega * np.asarray(t)[:, None, None] + phase), axis=1)


def recorded(stamps: np.ndarray, measured: np.ndarray, seed: int = 0, noise: float = 1e-5) -> Recording:
    """What was measured at some times, under other stamps; equal times are one sample."""
    rng = np.random.default_rng(seed + 1)
    times, which = np.unique(measured, return_inverse=True)
    q = motion(seed)(times) + noise * rng.standard_normal((times.size, 3))
    tau = 20.0 * np.cos(q) + 0.1 * rng.standard_normal(q.shape)
    return Recording(stamps, q[which], tau[which], JOINTS)


def read_from(period: float, n: int = 2000) -> tuple[np.ndarray, np.ndarray]:
    """Stamps of an even log, and when the last sample of a source had been measured at each."""
    stamps = STEP * np.arange(n)
    return stamps, np.floor((stamps + 0.3 * period) / period) * period


@pytest.mark.parametrize("ratio", [1.021, 1.1, 1.4, 0.98, 0.9])
def test_a_source_of_another_rate_is_put_on_its_own_clock(ratio: float) -> None:
    stamps, measured = read_from(ratio * STEP)
    seen = screen(recorded(stamps, measured))
    found = [f for f in seen.findings if f.check == "source_clock"]
    assert len(found) == 1
    told = re.search(r"measured at ([\d.]+) Hz, logged at 50 Hz", found[0].detail)
    assert told is not None
    assert float(told[1]) == pytest.approx(1 / (ratio * STEP), rel=1e-3)
    kept = seen.recording.used()
    assert len(kept) == np.unique(measured).size
    off = kept.time - measured[seen.recording.valid if seen.recording.valid is not None else slice(None)]
    assert np.ptp(off) < 0.05 * STEP  # a constant age is no fault: torque and position have it alike
    assert ("read twice" in found[0].detail) == (ratio > 1)
    assert ("passed over" in found[0].detail) == (ratio < 1)


def test_late_stamps_of_an_even_source_are_put_right() -> None:
    measured = STEP * np.arange(1500)
    stamps = measured + STEP * np.abs(np.random.default_rng(3).normal(0.0, 0.2, measured.size))
    seen = screen(recorded(stamps, measured))
    assert ["stamps scatter" in f.detail for f in seen.findings] == [True]
    assert np.ptp(seen.recording.time - measured) < 0.05 * STEP
    assert seen.recording.valid is None


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 10_000), jitter=st.floats(0.0, 0.3))
def test_stamps_of_when_samples_were_measured_stand(seed: int, jitter: float) -> None:
    rng = np.random.default_rng(seed)
    time = STEP * (np.arange(800) + jitter * rng.uniform(-1, 1, 800))
    whole = recorded(time, time, seed)
    assert not [f for f in screen(whole).findings if f.check == "source_clock"]
    source = np.arange(800)
    for row in np.sort(rng.integers(1, 800, 12)):  # what is lost repeats the last that came
        source[row] = source[row - 1]
    lost = replace(whole.rows(source), time=time)
    assert "source_clock" not in [f.check for f in screen(lost).findings]


def test_a_gap_parts_the_clock_and_a_rest_hides_none_of_it() -> None:
    stamps, measured = read_from(1.03 * STEP)
    whole = recorded(stamps, measured)
    cut = whole.rows(np.flatnonzero((stamps < 12.0) | (stamps > 14.0)))
    seen = screen(cut)
    assert [f.check for f in seen.findings] == ["source_clock"]
    gaps = np.diff(seen.recording.used().time)
    assert np.sum(gaps > 1.5 * STEP) == 1
    assert np.allclose(gaps[gaps < 1.5 * STEP], 1.03 * STEP, rtol=1e-2)
    still = np.clip(measured, 15.0, None)  # the arm waits for fifteen seconds, its torque is noise
    rng = np.random.default_rng(5)
    times, which = np.unique(measured, return_inverse=True)
    noise = 1e-5 * rng.standard_normal((times.size, 3))
    waiting = replace(whole, q=motion(0)(still) + noise[which])
    assert np.ptp(screen(waiting).recording.used().time - np.unique(measured)) < 0.05 * STEP


def test_too_short_or_still_recordings_have_no_clock() -> None:
    stamps, measured = read_from(1.03 * STEP, 60)
    assert source_clock(stamps, motion(0)(measured), STEP) is None
    assert source_clock(STEP * np.arange(500), np.zeros((500, 3)), STEP) is None


@pytest.mark.shared_data
def test_a_real_log_that_reads_its_arm_at_another_rate(shared_data) -> None:
    """Seen as a picture: every 1.7 s a sample is read twice, and the step behind it is of the usual size."""
    from lagnet.models.files.loading import load_any
    from lagnet.recordings.loading.load import load_recording

    log = load_recording(shared_data / "bags" / "panda_exciting_trajectory.db3", robot=load_any("panda"))
    seen = screen(log)
    assert [f.check for f in seen.findings] == ["source_clock"]
    assert "29.397 Hz, logged at 30 Hz" in seen.findings[0].detail
    assert seen.findings[0].rows.size == 14
