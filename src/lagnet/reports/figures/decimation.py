"""Choose the samples that a plot needs, so that peaks stay and the page stays small."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from lagnet.diagnosis.verdict.report_data import HeldOutSeries

SERIES_POINTS, CLOUD_POINTS = 4000, 3000  # of one joint
PAGE_POINTS = 20_000  # of one kind on a page, all joints together: keeps eight joints under a megabyte


def series_budget(n_joints: int) -> int:
    """Points for each joint's torque over time."""
    return min(SERIES_POINTS, PAGE_POINTS // max(n_joints, 1))


def cloud_budget(n_joints: int) -> int:
    """Points for each joint's residual against velocity."""
    return min(CLOUD_POINTS, PAGE_POINTS // max(n_joints, 1))


def extremes(values: np.ndarray, limit: int) -> np.ndarray:
    """Indices of the least and the greatest value of each of limit / 2 equal stretches; all if they are few enough."""
    n = len(values)
    if n <= limit:
        return np.arange(n)
    edges = np.linspace(0, n, limit // 2 + 1).astype(int)
    chosen = [
        index
        for start, stop in pairwise(edges)
        for index in {start + int(np.argmin(values[start:stop])), start + int(np.argmax(values[start:stop]))}
    ]
    return np.unique(chosen)


def scattered(n: int, limit: int) -> np.ndarray:
    """Indices of at most so many samples drawn without a rhythm that could beat with the motion's."""
    if n <= limit:
        return np.arange(n)
    return np.sort(np.random.default_rng(0).choice(n, limit, replace=False))


def segments_of(series: HeldOutSeries) -> tuple[tuple[int, int], ...]:
    """The unbroken motions; the whole series where none are told apart."""
    return tuple(segment for segment in series.segments if segment[1] > segment[0]) or ((0, len(series.time)),)


def end_to_end(series: HeldOutSeries) -> tuple[np.ndarray, np.ndarray, bool]:
    """A time axis on which no motion lies over another.

    Returns:
        time, shape (n,) [s]; the start of each motion on it [s]; whether motions had to be moved.
    """
    time = np.array(series.time, dtype=float)
    segments = segments_of(series)
    moved = any(time[b[0]] <= time[a[1] - 1] for a, b in pairwise(segments))
    if moved:
        gap = 0.02 * sum(time[stop - 1] - time[start] for start, stop in segments) / len(segments)
        clock = 0.0
        for start, stop in segments:
            time[start:stop] += clock - time[start]
            clock = time[stop - 1] + gap
    return time, np.array([time[start] for start, _ in segments]), moved


def broken(values: np.ndarray, series: HeldOutSeries, chosen: list[np.ndarray]) -> np.ndarray:
    """The chosen samples of each motion, with a gap between motions, so that no line joins them."""
    parts: list[np.ndarray] = []
    for (start, _), indices in zip(segments_of(series), chosen, strict=True):
        parts += [values[start + indices], np.array([np.nan])]
    return np.concatenate(parts[:-1])


def chosen_samples(series: HeldOutSeries, limit: int) -> list[np.ndarray]:
    """Indices within each motion, sharing the limit by length."""
    segments = segments_of(series)
    total = sum(stop - start for start, stop in segments)
    return [
        extremes(np.asarray(series.measured[start:stop]), max(int(limit * (stop - start) / total), 2))
        for start, stop in segments
    ]
