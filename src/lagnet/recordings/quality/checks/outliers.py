"""Single samples, or a few in a row, that lie off the curve of their neighbours."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from lagnet.recordings.quality.check import KINDS, QualityCheck, Subject
from lagnet.recordings.quality.finding import CERTAIN, LIKELY, NO_ROWS, Finding
from lagnet.recordings.quality.glitches import Glitch, glitches
from lagnet.recordings.quality.runs import resolution
from lagnet.recordings.sampling import median_step

LEAST_OF_RANGE = {"q": 1e-4, "v": 0.02, "tau": 0.05}  # of a moving channel's range: less does no harm
OF_BEND = 3.0  # times the second difference that 99 % of samples stay under: a joint that starts at once is no outlier
COMMON = 0.99
QUANTA = 5.0  # steps of a coarse scale: what goes up and down by fewer is the scale's
OUTRIGHT = 20.0  # times the least that is told: certain; of a torque that is its whole range
AROUND = 4  # samples on both sides in which an event would show in other signals, too
EVENT = 2.0  # times the bend that is usual: an impact or a stop, not a fault of the log
TURNING = 0.1  # of a joint's usual step: it is about to turn
OF_FRICTION = 0.4  # of the range of a torque, which dry friction may be
IMPOSSIBLE = 1000.0  # [rad/s²] or [m/s²] that no arm reaches
OVER_EFFORT = 2.0  # times the effort limit that no drive gives
SET_ASIDE = "they were set aside; look for the cause in the log's bus or converter"
LEFT = "they were left in, as an impact would look the same; look for the cause in the log's bus or converter"
MOST = 0.1  # of the samples that may be set aside before the recording is refused


class Outliers(QualityCheck):
    """Samples that leave the curve of their neighbours and come back within a few samples.

    A cubic through the two neighbours on either side predicts each sample (Hampel's rule on what that leaves, with a
    limit that heavy tails do not reach either); a run is an outlier where the curve meets itself without it. Impacts
    and stops show in motion and torque alike, and are none.
    """

    name = "outliers"
    title = "samples far off their neighbours"
    meaning = "One wrong sample in thousands turns into a large acceleration or torque: saturation, a heavier link."
    source = "hampel1974"

    def find(self, subject: Subject) -> Iterator[Finding]:
        for kind, values in subject.signals():
            for joint in range(values.shape[1]):
                yield from self._of_channel(subject, kind, joint, values)

    def _of_channel(self, subject: Subject, kind: str, joint: int, values: np.ndarray) -> Iterator[Finding]:
        x, least = values[:, joint], _least(subject, kind, joint, values)
        found: list[tuple[np.ndarray, Glitch]] = []
        for rows in subject.stretches:
            of_stretch = glitches(subject.recording.time[rows], x[rows], least)
            found += [(rows, g) for g in of_stretch if not _is_event(subject, kind, joint, rows, g)]
        if not found:
            return
        off = np.concatenate([rows[g.start : g.stop] for rows, g in found])
        rows, worst = max(found, key=lambda pair: pair[1].size)
        certain = worst.size > OUTRIGHT * least(1)
        aside = certain or kind != "tau"  # a gap's flanks and contacts hit the torque as briefly: they are physics
        yield self.found(
            subject,
            _words(subject, kind, joint, len(found), off.size, int(rows[worst.start]), worst.size),
            SET_ASIDE if aside else LEFT,
            CERTAIN if certain else LIKELY,
            channel=f"{kind}_{joint}",
            rows=np.sort(off),
            set_aside=np.sort(off) if aside else NO_ROWS,
            harmful=off.size > MOST * len(x),
        )


def _words(subject: Subject, kind: str, joint: int, runs: int, samples: int, at: int, size: float) -> str:
    value, time = getattr(subject.recording, kind)[at, joint], subject.recording.time[at]
    what = f"{runs} samples or short runs are" if runs > 1 else f"{samples} samples in a row are"
    what = "a sample is" if runs == samples == 1 else what
    worst = "the worst " if runs > 1 else ""
    off = f"{worst}{value:.4g} at t = {time:.6g} s, {size:.3g} {subject.unit(kind, joint)} off their curve"
    return f"{subject.named(kind, joint)}: {what} far off the neighbours, {off}"


def _least(subject: Subject, kind: str, joint: int, values: np.ndarray) -> Callable[[int], float]:
    """Deviation that does no harm, or that a sound signal of this kind may have, for runs of each length."""
    parts = [values[rows] for rows in subject.stretches]
    if not parts:
        return lambda length: np.inf
    of = np.concatenate(parts)[:, [joint] if subject.moves[joint] else slice(None)]
    low, high = np.quantile(of, [0.01, 0.99], axis=0)
    range_ = float((high - low).max())
    own = [part[:, joint] for part in parts]
    bend = OF_BEND * float(np.quantile(np.concatenate([np.abs(np.diff(x, n=2)) for x in own]), COMMON))
    plain = max(LEAST_OF_RANGE[kind] * range_, QUANTA * max(resolution(x) for x in own), 1e-12)
    if kind == "q":  # over a longer run a joint may go further: by half its acceleration times the time squared
        return lambda length: max(plain, bend * (0.5 * (length + 1)) ** 2)
    return lambda length: max(plain, bend)


def _is_event(subject: Subject, kind: str, joint: int, rows: np.ndarray, glitch: Glitch) -> bool:
    """Whether other signals bend at the same time as much as they hardly ever do, and what is seen is possible."""
    recording = subject.recording
    step = median_step(recording.time[rows])
    if kind == "q" and glitch.size > IMPOSSIBLE * (0.5 * (glitch.stop - glitch.start + 1) * step) ** 2:
        return False
    if (
        kind == "tau"
        and np.abs(recording.torque[rows[glitch.start], joint]) > OVER_EFFORT * subject.limits.effort[joint]
    ):
        return False
    near = slice(max(0, glitch.start - AROUND), glitch.stop + AROUND)
    if kind == "tau" and glitch.size < OF_FRICTION * np.ptp(recording.torque[rows, joint]):
        way = np.diff(recording.q[rows, joint])
        slow = np.abs(way[near]) < TURNING * np.median(np.abs(way))
        if slow.any() or np.ptp(np.sign(way[near])) > 0:  # dry friction turns round with the joint, there and back
            return True
    for other in KINDS:
        values = getattr(recording, other)
        if other == kind or values is None:
            continue
        table = values[rows][:, [joint]] if kind == "q" else values[rows]
        bends = np.abs(np.diff(table, n=2, axis=0))
        usual = np.quantile(bends, COMMON, axis=0)
        if bool(np.any((bends[near].max(axis=0, initial=0.0) > EVENT * usual) & (usual > 0))):
            return True
    return False
