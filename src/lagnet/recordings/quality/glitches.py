"""Short runs of samples off the curve of their neighbours, which comes back behind them as if nothing had happened.

A joint has inertia and a torque has neighbours: what leaves the curve for a few samples only is of the log. A step that
stays, or a kink, is none: leaving samples out does not make the two sides meet, or the samples lie between them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from lagnet.recordings.quality.interpolation import cubic_weights, off_neighbours
from lagnet.recordings.quality.runs import runs_of

LONGEST = 8  # samples of one run
OVER_MAD = 15.0  # times the robust standard deviation: white noise never comes near it
OVER_MOST = 8.0  # times the deviation that 98 % of samples stay under, which heavy tails make large
COMMON = 0.98
MEETING = 0.2  # of the run's deviation that its neighbours may be off when the run is left out
ORDINARY = 0.5  # of the limit that its neighbours may be off at most
TOO_MANY = 0.05  # of the samples flagged: the signal is not smooth, and nothing can be told
BETWEEN = 0.5  # of the run's deviation that it must leave its neighbours' range by: the edge of a step stays in it
EDGE = 4  # samples at the ends of a stretch that have too few neighbours
ENOUGH = 100_000  # runs of each length, spread over a channel, from which its threshold is taken


@dataclass(frozen=True)
class Glitch:
    """A run of rows `start` … `stop` - 1 and its largest deviation from the curve through its neighbours."""

    start: int
    stop: int
    size: float


def threshold(deviation: np.ndarray, least: float) -> float:
    """Deviation beyond which a sample is none of its signal.

    Args:
        deviation: shape (n,), of all samples from their neighbours.
        least: threshold of signals that have hardly any noise.
    """
    size = np.abs(deviation)
    scale = 1.4826 * float(np.median(size))
    return max(OVER_MAD * scale, OVER_MOST * float(np.quantile(size, COMMON)), least)


def glitches(time: np.ndarray, x: np.ndarray, least: Callable[[int], float]) -> Iterator[Glitch]:
    """Each glitch of one channel of a stretch.

    Args:
        time: shape (n,), [s].
        x: shape (n,).
        least: for a number of samples, the deviation below which a run of so many is not told.
    """
    if len(x) < 4 * LONGEST:
        return
    rows = np.arange(EDGE, len(x) - EDGE)
    deviation = off_neighbours(time, x, rows)
    limits = _Limits(time, x, least)
    limit = limits.of(1)
    flagged = np.zeros(len(x), dtype=bool)
    flagged[rows] = np.abs(deviation) > limit / 3.0
    strong = np.zeros(len(x), dtype=bool)
    strong[rows] = np.abs(deviation) > limit / 2.0
    if flagged.mean() > TOO_MANY:
        return
    for start, stop in _clusters(flagged):
        if strong[start:stop].any():
            found = _shortest(time, x, start, stop, limits)
            if found is not None:
                yield found


class _Limits:
    """Thresholds for runs of each length: the curve over a longer run is less certain, as the signal itself shows."""

    def __init__(self, time: np.ndarray, x: np.ndarray, least: Callable[[int], float]):
        self._time, self._x, self._least, self._known = time, x, least, {}

    def of(self, length: int) -> float:
        """The threshold for a run of so many samples."""
        if length not in self._known:
            last = len(self._x) - EDGE - length
            first = np.arange(EDGE, last, max(1, (last - EDGE) // ENOUGH))
            nodes = first[:, None] + np.array([-2, -1, length, length + 1])
            middle = first + (length - 1) // 2
            curve = np.einsum("ki,ki->k", cubic_weights(self._time, nodes, middle), self._x[nodes])
            self._known[length] = threshold(self._x[middle] - curve, self._least(length))
        return self._known[length]


def _clusters(flagged: np.ndarray) -> Iterator[tuple[int, int]]:
    """Runs of flagged samples; those with fewer than LONGEST samples between them are one."""
    runs = runs_of(flagged)
    if not len(runs):
        return
    breaks = np.flatnonzero(runs[1:, 0] - runs[:-1, 1] >= LONGEST) + 1
    for part in np.split(runs, breaks):
        yield int(part[0, 0]), int(part[-1, 1])


def _shortest(time: np.ndarray, x: np.ndarray, start: int, stop: int, limits: _Limits) -> Glitch | None:
    """The shortest run in a cluster without which the two sides meet."""
    if stop - start > LONGEST + 4:
        return None
    for length in range(1, LONGEST + 1):
        firsts = np.arange(max(EDGE, start), min(stop, len(x) - EDGE - length) + 1)
        tried = [g for first in firsts if (g := _left_out(time, x, int(first), length, limits.of(length))) is not None]
        if tried:
            return max(tried, key=lambda g: g.size)
    return None


def _left_out(time: np.ndarray, x: np.ndarray, first: int, length: int, limit: float) -> Glitch | None:
    """A run as a glitch: it is far off the curve through the samples around it, and these are on it."""
    stop = first + length
    run, around = np.arange(first, stop), np.array([first - 2, first - 1, stop, stop + 1])
    size = float(np.max(np.abs(x[run] - cubic_weights(time, np.tile(around, (length, 1)), run) @ x[around])))
    if size < limit or _beyond(x[run], x[around]) < BETWEEN * size:
        return None
    before = off_neighbours(time, x, np.array([first - 1]), length)[0]
    behind = -off_neighbours(-time[::-1], x[::-1], np.array([len(x) - 1 - stop]), length)[0]
    outer = off_neighbours(time, x, np.array([first - 3, stop + 2]))[[0, 1]] if first >= 5 and stop + 5 < len(x) else ()
    off = max(abs(before), abs(behind), *(abs(o) for o in outer))
    return Glitch(first, stop, size) if off < min(MEETING * size, ORDINARY * limit) else None


def _beyond(run: np.ndarray, around: np.ndarray) -> float:
    """How far a run leaves the range of the samples around it."""
    return float(max(run.max() - around.max(), around.min() - run.min(), 0.0))
