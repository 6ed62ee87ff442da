"""The motion of a recording at its own samples: as recorded where all of it was, else smoothed and differentiated."""

from __future__ import annotations

import numpy as np

from lagnet.recordings.recording import Recording
from lagnet.types import Trajectory


def motion_of(recording: Recording) -> tuple[Trajectory, Trajectory, Trajectory, str]:
    """q, v, a at every sample, each of shape (n, dof), and where they come from: "recorded" or "differentiated".

    Raises:
        RecordingError: no stretch is long enough to differentiate.
    """
    if recording.v is not None and recording.a is not None:
        return recording.q, recording.v, recording.a, "recorded"
    from lagnet.recordings.conditioning.condition import condition, motion_at_samples

    conditioned = condition([recording])
    q, v, a = motion_at_samples(recording, conditioned, 0)
    return np.asarray(q), np.asarray(v), np.asarray(a), "differentiated"
