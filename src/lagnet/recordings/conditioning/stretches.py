"""Where a recording is uninterrupted: between gaps in its clock and ends of trajectories."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from lagnet.recordings.recording import Recording

GAP = 8.0  # steps longer than this many median steps interrupt a stretch


def stretches_of(recording: Recording) -> list[slice]:
    """Rows of each uninterrupted stretch, in order; repeated timestamps do not interrupt.

    Samples that are set aside interrupt a stretch where a gap in time as long as theirs would.
    """
    rows = np.arange(len(recording)) if recording.valid is None else np.flatnonzero(recording.valid)
    if not rows.size:
        return []
    steps = np.diff(recording.time[rows])
    same = np.diff(recording.trajectory[rows]) == 0
    usual = np.median(steps[same]) if same.any() else 0.0
    cuts = np.flatnonzero(~same | (steps > GAP * usual)) + 1
    edges = [0, *cuts.tolist(), rows.size]
    return [slice(int(rows[a]), int(rows[b - 1]) + 1) for a, b in pairwise(edges) if b > a]
