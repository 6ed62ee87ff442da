"""Splits keep motions and stretches of time together."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lagnet.errors import RecordingError
from lagnet.recordings.recording import Recording
from lagnet.recordings.splits import MIN_PART, block_folds, fold_of_samples, holdout_split


def motions(*lengths: int) -> Recording:
    """Motions of given lengths, each with its own clock; q numbers the samples."""
    n = sum(lengths)
    time = np.concatenate([0.01 * np.arange(length) for length in lengths])
    q = np.arange(n, dtype=float)[:, None]
    names = tuple(f"m{i}" for i in range(len(lengths))) if len(lengths) > 1 else ("0",)
    return Recording(
        time=time,
        q=q,
        tau=-q,
        joints=("j",),
        v=q + 1,
        trajectory=np.repeat(np.arange(len(lengths)), lengths),
        trajectory_names=names,
        path="run.csv",
    )


def test_the_last_fifth_of_a_single_motion_is_held_out() -> None:
    (fit,), (held,) = holdout_split([motions(1000)])
    assert len(fit) == 800
    assert len(held) == 200
    assert fit.time[-1] < held.time[0]
    assert held.path == "run.csv"


def test_whole_motions_are_held_out_and_numbered_from_zero() -> None:
    (fit,), (held,) = holdout_split([motions(100, 100, 100, 100, 90)])
    assert (len(fit), len(held)) == (400, 90)
    assert fit.trajectory_names == ("m0", "m1", "m2", "m3")
    assert held.trajectory_names == ("m4",)
    assert set(held.trajectory) == {0}


def test_each_recording_gives_one_part_to_either_side_in_order() -> None:
    fit, held = holdout_split([motions(200), motions(100, 100)], fraction=0.5)
    assert [len(part) for part in fit] == [100, 100]
    assert [len(part) for part in held] == [100, 100]


@given(st.lists(st.integers(MIN_PART, 200), min_size=2, max_size=8), st.floats(0.05, 0.95))
def test_no_motion_is_torn_and_no_sample_lost(lengths: list[int], fraction: float) -> None:
    recording = motions(*lengths)
    (fit,), (held,) = holdout_split([recording], fraction)
    np.testing.assert_array_equal(np.r_[fit.q, held.q], recording.q)
    assert fit.trajectory_names + held.trajectory_names == recording.trajectory_names
    assert all(len(part) == length for part, length in zip([*fit.parts(), *held.parts()], lengths, strict=True))


@pytest.mark.parametrize("fraction", [0.0, 1.0, -0.2, 1.5, float("nan")])
def test_a_fraction_that_leaves_nothing_is_refused(fraction: float) -> None:
    with pytest.raises(RecordingError, match="must lie between 0 and 1"):
        holdout_split([motions(100)], fraction)


def test_a_recording_too_short_to_cut_is_refused() -> None:
    with pytest.raises(RecordingError, match=r"run\.csv: 30 samples are too few.*--holdout"):
        holdout_split([motions(30)])


@given(st.lists(st.integers(1, 80), min_size=1, max_size=9), st.integers(2, 5))
def test_folds_judge_every_sample_once_in_contiguous_stretches(lengths: list[int], n_folds: int) -> None:
    trajectory = np.repeat(np.arange(len(lengths)), lengths)
    if trajectory.size < n_folds:
        return
    fold = fold_of_samples(trajectory, n_folds)
    assert (np.diff(fold) >= 0).all()
    assert set(fold) == set(range(n_folds))
    if len(lengths) >= n_folds:
        assert all(len(set(fold[trajectory == k])) == 1 for k in range(len(lengths)))


def test_a_gap_keeps_the_fit_away_from_the_judged_stretch() -> None:
    recording = motions(1000)
    folds = block_folds(recording, n_folds=5, gap=0.1)
    assert len(folds) == 5
    np.testing.assert_array_equal(np.sort(np.concatenate([fold.judge for fold in folds])), np.arange(1000))
    for fold in folds:
        distance = np.abs(recording.time[fold.fit][:, None] - recording.time[fold.judge][None]).min()
        assert distance > 0.1
    assert folds[2].fit.size == 1000 - 200 - 20


def test_a_gap_does_not_reach_into_other_motions() -> None:
    folds = block_folds(motions(100, 100, 100), n_folds=3, gap=10.0)
    assert [fold.fit.size for fold in folds] == [200, 200, 200]


def test_too_few_samples_for_the_folds_are_refused() -> None:
    with pytest.raises(RecordingError, match="60 samples cannot be cut into 5 folds"):
        block_folds(motions(60))
    with pytest.raises(RecordingError, match="cannot be cut into 1 folds"):
        block_folds(motions(600), n_folds=1)
