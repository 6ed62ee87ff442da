"""Where a recording exceeds what the robot's description allows."""

from __future__ import annotations

from typing import Any

import numpy as np

from lagnet.plausibility.check import Finding, NotApplicable
from lagnet.plausibility.subject import Subject
from lagnet.recordings.recording import Recording


def limits_of(subject: Subject, name: str) -> np.ndarray:
    """A limit of each joint, shape (dof,), of the model or of its reference.

    Raises:
        NotApplicable: no recording, or neither has such limits.
    """
    if not subject.recordings:
        raise NotApplicable("no recording was given")
    for source in (subject.model, subject.reference):
        values = getattr(source, name, None)
        if values is not None and np.isfinite(np.asarray(values, dtype=float)).any():
            values = np.asarray(values, dtype=float)
            return np.where(values == 0, np.inf, values) if name in ("velocity_limit", "effort_limit") else values
    raise NotApplicable(f"neither model nor reference has a {name.replace('_', ' ')}")


def largest_share(subject: Subject, signal: str, limit: np.ndarray, words: str) -> Finding:
    """The largest |signal| over its limit in all recordings.

    Raises:
        NotApplicable: no recording holds the signal.
    """
    found = []
    for recording in subject.recordings:
        values = getattr(recording, signal)
        if values is not None:
            share = np.abs(values) / limit
            row, joint = (int(i) for i in np.unravel_index(np.argmax(share), share.shape))
            detail = (
                f"{words} of {subject.joints[joint]} is {values[row, joint]:.4g} {subject.unit(signal, joint)}, "
                f"limit {limit[joint]:.4g}; share of it"
            )
            found.append(Finding(float(share[row, joint]), place(subject, recording, row, joint), detail))
    if not found:
        raise NotApplicable(f"no recording holds {words}")
    return max(found, key=lambda f: f.value)


def place(subject: Subject, recording: Recording, row: int, joint: int) -> dict[str, Any]:
    """A sample of a recording, for people."""
    where: dict[str, Any] = {"joint": subject.joints[joint], "time": float(recording.time[row]), "row": row}
    return {"recording": recording.path, **where} if recording.path else where
