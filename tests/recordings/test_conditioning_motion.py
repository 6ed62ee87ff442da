"""From samples with every fault a clock and an encoder can have to smooth motion: what is kept, what is refused."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import butter, sosfiltfilt

from lagnet.errors import RecordingError
from lagnet.recordings.conditioning.bandwidth import choose_bandwidth
from lagnet.recordings.conditioning.condition import condition, motion_at_samples
from lagnet.recordings.conditioning.noise import white_noise
from lagnet.recordings.conditioning.smoothing import ORDER, derivative, even_clock, low_pass, resample
from lagnet.recordings.conditioning.stretches import stretches_of
from lagnet.recordings.recording import Recording

RATE = 200.0  # [Hz]
OMEGA = np.array([2.0, 3.1])  # [rad/s], half a hertz: far below every bandwidth
SETTLED = 0.5  # [s] at the ends of a stretch where filters settle
SMOOTH = 2e-4  # relative: motion of half a hertz through splines and filters of five hertz and more, without noise

Clock = Callable[[np.random.Generator, int], np.ndarray]


def exact(time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    angle = time[:, None] * OMEGA + np.array([0.3, 1.0])
    return np.sin(angle), OMEGA * np.cos(angle), -(OMEGA**2) * np.sin(angle)


def record(time: np.ndarray, noise: float = 0.0, seed: int = 0, velocity: bool = False) -> Recording:
    rng = np.random.default_rng(seed)
    q, v, _ = exact(time)
    tau = 5.0 * np.cos(time[:, None] * OMEGA) + noise * rng.standard_normal(q.shape)
    v = v if velocity else None
    return Recording(time, q + noise * rng.standard_normal(q.shape), tau, ("a", "b"), v=v)


def even(rng: np.random.Generator, n: int) -> np.ndarray:
    return np.arange(n) / RATE


def jittered(rng: np.random.Generator, n: int) -> np.ndarray:
    return np.arange(n) / RATE + rng.uniform(-0.3, 0.3, n) / RATE


def stamped_late(rng: np.random.Generator, n: int) -> np.ndarray:
    return 1.0e6 + np.arange(n) / RATE  # seconds since some epoch


@pytest.mark.parametrize("clock", [even, jittered, stamped_late])
def test_velocity_and_acceleration_are_those_of_the_motion(clock: Clock) -> None:
    time = clock(np.random.default_rng(1), 2000)
    ready = condition([record(time - time[0])])
    assert len(ready.stretches) == 1
    stretch = ready.stretches[0]
    inside = (stretch.time > SETTLED) & (stretch.time < stretch.time[-1] - SETTLED)
    for found, truth in zip((stretch.q, stretch.v, stretch.a), exact(stretch.time), strict=True):
        error = np.abs(found - truth)[inside].max() / np.abs(truth).max()
        assert error < SMOOTH


def test_a_clock_that_starts_late_changes_nothing() -> None:
    time = even(np.random.default_rng(0), 1200)
    early = record(time, noise=1e-4)
    late = condition([replace(early, time=time + 4096.0)]).stretches[0]
    here = condition([early]).stretches[0]
    np.testing.assert_allclose(late.a, here.a, atol=1e-5 * np.abs(here.a).max())


def test_the_clock_of_every_stretch_is_even_and_inside_the_recording() -> None:
    time = jittered(np.random.default_rng(2), 900)
    ready = condition([record(time)])
    for stretch in ready.stretches:
        np.testing.assert_allclose(np.diff(stretch.time), 1.0 / ready.rate, rtol=1e-6)
        assert stretch.time[0] >= time[stretch.first]
        assert stretch.time[-1] <= time[stretch.last] + 1e-9


def test_a_gap_ends_a_stretch_and_no_filter_crosses_it() -> None:
    time = even(np.random.default_rng(0), 1600)
    time[800:] += 2.0
    broken = record(time, noise=1e-3)
    assert stretches_of(broken) == [slice(0, 800), slice(800, 1600)]
    whole, alone = condition([broken], bandwidth=10.0), condition([broken.rows(slice(0, 800))], bandwidth=10.0)
    assert [(s.first, s.last) for s in whole.stretches] == [(0, 799), (800, 1599)]
    np.testing.assert_array_equal(whole.stretches[0].q, alone.stretches[0].q)


def test_trajectories_never_share_a_filter() -> None:
    time = even(np.random.default_rng(0), 1000)
    labels = np.repeat([0, 1], 500)
    both = replace(record(time, noise=1e-3), trajectory=labels, trajectory_names=("0", "1"))
    other = both.q.copy()
    other[500:] += 5.0  # what the second motion does has no bearing on the first
    moved = replace(both, q=other)
    first, changed = (condition([r], bandwidth=10.0).stretches[0] for r in (both, moved))
    assert len(condition([both]).stretches) == 2
    for name in ("q", "v", "a", "tau"):
        np.testing.assert_array_equal(getattr(first, name), getattr(changed, name))


def test_repeated_timestamps_are_survived() -> None:
    time = even(np.random.default_rng(0), 800)
    time[100] = time[99]
    time[400:403] = time[400]
    ready = condition([record(time)])
    assert len(ready.stretches) == 1
    stretch = ready.stretches[0]
    assert np.isfinite(stretch.a).all()
    inside = (stretch.time > SETTLED) & (stretch.time < 3.0)
    assert np.abs(stretch.v - exact(stretch.time)[1])[inside].max() < 0.05 * OMEGA.max()


def test_quantised_positions_give_usable_accelerations() -> None:
    step = 2.0 * np.pi / 2**14
    time = even(np.random.default_rng(0), 3000)
    rough = record(time)
    rough = replace(rough, q=step * np.round(rough.q / step))
    ready = condition([rough])
    inside = slice(200, -200)
    stretch = ready.stretches[0]
    off = low_pass(stretch.a - exact(stretch.time)[2], RATE, ready.bandwidth)  # as the torque that it makes
    error = np.sqrt(np.mean(off[inside] ** 2, axis=0))
    raw = np.sqrt(np.mean(np.diff(rough.q, n=2, axis=0) ** 2, axis=0)) * RATE**2
    assert np.all(error < 0.05 * raw)  # twice differenced steps would bury the motion
    assert np.all(error < 2.0 * ready.noise_a)


def test_recorded_velocity_is_used_where_it_is_the_better_one() -> None:
    time = even(np.random.default_rng(0), 3000)
    rng = np.random.default_rng(4)
    q, v, _ = exact(time)
    noisy = replace(record(time), q=q + 5e-4 * rng.standard_normal(q.shape), v=v + 1e-4 * rng.standard_normal(q.shape))
    ready, without = condition([noisy]), condition([replace(noisy, v=None)])
    assert (ready.velocity_from, without.velocity_from) == ("recorded", "differentiated")
    truth, inside = exact(ready.stretches[0].time)[1], slice(300, -300)
    errors = [np.sqrt(np.mean((c.stretches[0].v - truth)[inside] ** 2)) for c in (ready, without)]
    assert errors[0] < 0.5 * errors[1]


def test_velocity_that_lags_is_refused() -> None:
    time = even(np.random.default_rng(0), 3000)
    rng = np.random.default_rng(5)
    late = exact(time - 0.04)[1]
    lagging = replace(record(time), q=exact(time)[0] + 5e-4 * rng.standard_normal((3000, 2)), v=late)
    refused = condition([lagging])
    assert refused.velocity_from == "differentiated"
    assert "% off the rate at which the position changes" in refused.velocity_reason
    assert record(time).joints[0] in refused.velocity_reason or record(time).joints[1] in refused.velocity_reason


def test_why_velocity_is_differentiated_is_told() -> None:
    time = even(np.random.default_rng(0), 3000)
    rng = np.random.default_rng(6)
    rough = replace(record(time), v=exact(time)[1] + 0.02 * rng.standard_normal((3000, 2)))
    assert "noisier" in condition([rough]).velocity_reason
    assert "no recording has speeds" in condition([replace(record(time), v=None)]).velocity_reason


@pytest.mark.parametrize("bandwidth", [3.0, 10.0, 30.0])
def test_the_filter_has_no_phase(bandwidth: float) -> None:
    time = np.arange(0.0, 20.0, 1.0 / RATE)
    x = np.sin(2.0 * np.pi * 0.8 * bandwidth * time)[:, None]
    y = low_pass(x, RATE, bandwidth)
    inside = slice(int(3 * RATE), -int(3 * RATE))
    quadrature = np.cos(2.0 * np.pi * 0.8 * bandwidth * time)[:, None]
    gain = np.mean(y[inside] * x[inside]) / np.mean(x[inside] ** 2)
    assert abs(np.mean(y[inside] * quadrature[inside])) < 1e-3 * gain
    assert 0.5 < gain < 1.0


def test_a_filter_run_backwards_is_the_same_filter() -> None:
    x = np.random.default_rng(0).standard_normal((800, 2))
    forth, back = low_pass(x, RATE, 12.0), low_pass(x[::-1], RATE, 12.0)[::-1]
    np.testing.assert_allclose(forth[100:-100], back[100:-100], atol=1e-6)


def test_derivative_is_accurate_to_high_order() -> None:
    errors = []
    for rate in (50.0, 100.0):
        time = np.arange(0.0, 4.0, 1.0 / rate)
        found = derivative(time, np.sin(8.0 * time)[:, None])[:, 0]
        errors.append(np.abs(found - 8.0 * np.cos(8.0 * time))[20:-20].max())
    assert errors[1] < 1e-6
    assert errors[1] < errors[0] / 20.0


def test_resampling_is_exact_where_the_times_coincide() -> None:
    time = jittered(np.random.default_rng(3), 200)
    x = np.random.default_rng(4).standard_normal((200, 3))
    np.testing.assert_allclose(resample(time, x, time[10:20]), x[10:20], atol=1e-12)
    clock = even_clock(time, RATE)
    assert clock[0] == time[0]
    assert clock[-1] <= time[-1] + 1e-9


def test_the_bandwidth_is_chosen_from_the_motion_and_stated() -> None:
    slow, quick = (record(f * even(np.random.default_rng(0), 4000)) for f in (0.5, 1.0))
    slow, quick = (replace(r, time=even(np.random.default_rng(0), 4000)) for r in (slow, quick))
    assert 5.0 <= chosen(slow) <= chosen(quick) <= 40.0
    assert condition([quick]).bandwidth == chosen(quick)
    assert condition([quick], bandwidth=7.5).bandwidth == 7.5
    coarse = replace(quick.rows(slice(0, None, 10)))  # 20 Hz: no more than a fifth of the rate
    assert chosen(coarse) <= 0.2 * coarse.rate + 1e-9


def chosen(recording) -> float:
    return choose_bandwidth([recording], {"q": white_noise(recording.q)})


@pytest.mark.parametrize("step", [1e-5, 1e-4, 4e-4])
def test_a_coarse_encoder_does_not_pass_for_quick_motion(step: float) -> None:
    fine = record(even(np.random.default_rng(0), 6000))
    coarse = replace(fine, q=np.round(fine.q / step) * step)
    assert chosen(coarse) <= chosen(fine)
    truth = condition([fine], chosen(coarse)).stretches[0].a
    assert np.median(np.std(condition([coarse]).stretches[0].a - truth, axis=0) / np.std(truth, axis=0)) < 0.2


def test_motion_comes_back_at_every_sample_as_given() -> None:
    time = jittered(np.random.default_rng(7), 1000)
    time[600:] += 1.0
    given = record(time)
    ready = condition([given])
    q, v, a = motion_at_samples(given, ready, 0)
    assert q.shape == v.shape == a.shape == given.q.shape
    truth = exact(time)
    inside = np.r_[120:480, 720:880]
    for found, expected in zip((q, v, a), truth, strict=True):
        assert np.abs(found - expected)[inside].max() < 5e-3 * np.abs(expected).max()


def test_samples_outside_every_stretch_stand_still() -> None:
    time = even(np.random.default_rng(0), 400)
    time[390:] += 3.0  # ten samples are too few to be differentiated
    given = record(time)
    q, v, a = motion_at_samples(given, condition([given]), 0)
    np.testing.assert_array_equal(q[390:], given.q[390:])
    assert not v[390:].any()
    assert not a[390:].any()


def test_several_recordings_keep_their_index_and_share_one_rate() -> None:
    first, second = record(even(np.random.default_rng(0), 500)), record(even(np.random.default_rng(0), 700))
    ready = condition([first, second])
    assert [s.recording for s in ready.stretches] == [0, 1]
    assert ready.rate == pytest.approx(RATE)


@pytest.mark.parametrize("shape", [(40,), (400, 3), (1000, 2)])
def test_the_low_pass_is_scipys_forth_and_back(shape: tuple[int, ...]) -> None:
    x = np.random.default_rng(3).normal(size=shape)
    sections = butter(ORDER, 5.0, fs=100.0, output="sos")
    expected = sosfiltfilt(sections, x, axis=0, padlen=min(shape[0] - 1, 40))
    np.testing.assert_array_equal(low_pass(x, 100.0, 5.0), expected)


def test_recordings_of_pieces_too_short_to_differentiate_are_refused_with_how_long_they_are() -> None:
    time = np.arange(60) / RATE
    broken = record(time + (np.arange(60) >= 30))  # a second's gap in the middle
    for short in ([record(time[:20])], [broken, record(time[:12])]):
        longest = max(rows.stop - rows.start for r in short for rows in stretches_of(r))
        with pytest.raises(RecordingError, match=f"{longest} samples without a gap are too few to differentiate"):
            condition(short)
    assert len(condition([broken, record(time)]).stretches) == 1
