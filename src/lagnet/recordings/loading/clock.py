"""What is wrong with a recording's clock, and what can be survived: repeats, gaps, jitter."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.errors import RecordingError
from lagnet.recordings.readers.source import RowNames

GAP = 5.0  # steps longer than this many median steps are gaps
JITTER = 0.2  # spread of steps (5th to 95th percentile) over the median step above which it is told
SLOW = 0.5  # [s] a median step beyond it is hardly a control clock: milliseconds?


@dataclass(frozen=True)
class Motions:
    """Which motion each sample belongs to.

    Args:
        index: shape (n,), 0, 1, … in order of appearance.
        names: the file's own label of each.
    """

    index: np.ndarray
    names: tuple[str, ...]


def motions(labels: np.ndarray | None, n: int, rows: RowNames, where: str) -> Motions:
    """Number the trajectory labels in order of appearance.

    Raises:
        RecordingError: the samples of one motion do not stand together.
    """
    if labels is None:
        return Motions(np.zeros(n, dtype=np.int64), ("0",))
    starts = np.flatnonzero(np.r_[True, labels[1:] != labels[:-1]])
    names = tuple(map(str, labels[starts]))
    seen: dict[str, int] = {}
    for start, name in zip(starts, names, strict=True):
        if name in seen:
            raise RecordingError(
                f"{rows.of(int(start))}: trajectory {name!r} comes back after another one",
                where=where,
                next_step="keep the samples of a motion together, or give each motion its own label",
            )
        seen[name] = int(start)
    return Motions(np.repeat(np.arange(starts.size), np.diff(np.r_[starts, n])), names)


def first_of_repeats(time: np.ndarray, index: np.ndarray, rows: RowNames) -> tuple[np.ndarray, tuple[str, ...]]:
    """Keep the first of samples with the same time stamp.

    Args:
        time: shape (n,), [s].
        index: shape (n,), motion of each sample.

    Returns:
        Mask of the samples to keep, shape (n,), and what to tell.
    """
    repeated = np.r_[False, (np.diff(time) == 0) & (np.diff(index) == 0)]
    count = int(repeated.sum())
    if not count:
        return ~repeated, ()
    first = rows.of(int(np.flatnonzero(repeated)[0]))
    return ~repeated, (
        f"{count} repeated time stamp{'s' * (count > 1)}, the first on {first}: the first sample of each was kept",
    )


def refuse_backward(time: np.ndarray, index: np.ndarray, labelled: bool, rows: RowNames, where: str) -> None:
    """Time must not run back inside a motion.

    Raises:
        RecordingError: names the row.
    """
    back = np.flatnonzero((np.diff(time) < 0) & (np.diff(index) == 0))
    if not back.size:
        return
    at = int(back[0]) + 1
    restart = not labelled and time[at] <= time[0] + 0.01 * (time[at - 1] - time[0])
    raise RecordingError(
        f"{rows.of(at)}, column time: time runs back from {time[at - 1]:.9g} to {time[at]:.9g} s"
        + (f" ({back.size} times in all)" if back.size > 1 else ""),
        where=where,
        next_step="several motions in one file need a trajectory column"
        if restart
        else "sort the samples, or label separate motions in a trajectory column",
    )


def describe_steps(time: np.ndarray, index: np.ndarray, names: tuple[str, ...], rows: RowNames) -> tuple[str, ...]:
    """Warnings about gaps, jitter and a clock that looks like milliseconds.

    Args:
        time: shape (n,), [s], strictly increasing in each motion.
        index: shape (n,), motion of each sample.
        names: names of the motions.
    """
    inside = np.flatnonzero(np.diff(index) == 0)
    if not inside.size:
        return ()
    steps = np.diff(time)[inside]
    median = float(np.median(steps))
    told = []
    gaps = np.flatnonzero(steps > GAP * median)
    if gaps.size:
        worst = inside[gaps[np.argmax(steps[gaps])]]
        motion = f" of trajectory {names[index[worst]]}" if len(names) > 1 else ""
        told.append(
            f"{gaps.size} gap{'s' * (gaps.size > 1)} in time (more than {GAP:g} median steps), the longest"
            f" {time[worst + 1] - time[worst]:.4g} s after {rows.of(int(worst))} (t = {time[worst]:.6g} s{motion})"
        )
    low, high = np.percentile(steps, [5, 95])
    if high - low > JITTER * median:
        told.append(f"the clock jitters: steps of {1e3 * low:.3g} to {1e3 * high:.3g} ms around {1e3 * median:.3g} ms")
    if median > SLOW:
        told.append(f"a sample every {median:.3g} s: if the clock counts milliseconds, map [scale] time = 0.001")
    return tuple(told)
