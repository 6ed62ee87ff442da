"""Signals that were recorded more often than they were measured."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lagnet.recordings.quality.check import QualityCheck, Subject
from lagnet.recordings.quality.finding import CERTAIN, Finding
from lagnet.recordings.quality.runs import quantum

OFTEN = 0.25  # of the rows of a moving channel that repeat the one before
COARSE = 5.0  # quanta that a channel changes by when it does: a slow signal on a coarse scale repeats itself too
TOGETHER = 0.95  # of the changes of all held channels that fall into the same rows
EVEN = 0.8  # of the runs that are within a sample of the usual length
AGREE = 2  # channels of a kind that must be held alike, where there are so many


class HeldSamples(QualityCheck):
    """Channels that keep each value for several samples and then change by many of their quanta, all at once."""

    name = "held_samples"
    title = "samples are held: recorded more often than measured"
    meaning = "A staircase has no speed between its steps, and friction is then not seen at all."

    def find(self, subject: Subject) -> Iterator[Finding]:
        held = {kind: _held(subject, values) for kind, values in subject.signals()}
        fresh = {kind: rows for kind, rows in held.items() if rows is not None}
        if not fresh:
            return
        recording, kinds = subject.recording, list(fresh)
        rows = np.unique(np.concatenate(list(fresh.values())))
        apart = min(r.size for r in fresh.values()) < TOGETHER * rows.size
        every = len(recording) / max(1, rows.size)
        said = f"{', '.join(kinds)} {'are' if len(kinds) > 1 else 'is'} recorded at {recording.rate:.4g} Hz but"
        said += f" measured at about {recording.rate / every:.3g} Hz: each value is held for {every:.3g} samples"
        if "q" not in fresh or apart:
            yield self.found(
                subject,
                said + (", at other rows than the other signals" if len(fresh) > 1 else ""),
                "record every signal at one rate, or write each value once, at the time at which it was measured",
                CERTAIN,
                channel=" ".join(kinds),
                harmful=True,
            )
            return
        stale = np.setdiff1d(np.arange(len(recording)), rows)
        yield self.found(
            subject,
            said,
            "the repeated samples were set aside; write each value once, at the time at which it was measured",
            CERTAIN,
            channel=" ".join(kinds),
            set_aside=stale,
        )


def _held(subject: Subject, values: np.ndarray) -> np.ndarray | None:
    """Rows at which a held kind of signal is fresh; None where it is not held."""
    tried = (_changes(values[:, j], bool(subject.moves[j])) for j in range(values.shape[1]))
    changed = [c for c in tried if c is not None]
    if len(changed) < min(AGREE, values.shape[1]):
        return None
    counts = np.sum(changed, axis=0)
    fresh = np.flatnonzero(counts > 0)
    lengths = np.diff(fresh)
    usual = np.median(lengths)
    together = np.mean(counts[fresh] >= 0.5 * len(changed))
    even = np.mean(np.abs(lengths - usual) <= 1) if lengths.size else 0.0
    return fresh if together > TOGETHER and even > EVEN and usual >= 2 else None


def _changes(x: np.ndarray, moves: bool) -> np.ndarray | None:
    """Where a channel takes a new value, shape (n,), if it is held: None where it is not."""
    steps = np.abs(np.diff(x))
    moved = steps[steps > 0]
    if not moves or moved.size < 20 or np.mean(steps == 0) < OFTEN:
        return None
    smallest = max(quantum(x), float(np.quantile(moved, 0.01)))
    if float(np.median(moved)) < COARSE * smallest:
        return None
    return np.concatenate([[True], steps > 0])
