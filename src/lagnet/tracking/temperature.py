"""Temperature of each joint during a recording: of the file's own columns, or stated in the manifest."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from lagnet.recordings.loading.load import open_source
from lagnet.recordings.recording import Recording


def joint_temperature(recording: Recording, file: Path, stated: float | None) -> list[float | None]:
    """Mean temperature of each joint [°C]; None where nothing is known of it.

    Args:
        recording: as read.
        file: from which it was read; its columns `temperature_i` or `temperature_JOINT` are looked up.
        stated: of the manifest; goes before what the file holds.
    """
    if stated is not None:
        return [float(stated)] * recording.n_dof
    known = getattr(recording, "temperature", None)
    if known is not None:
        return [_mean(known[:, j]) for j in range(recording.n_dof)]
    return _columns(recording.joints, file)


def _columns(joints: tuple[str, ...], file: Path) -> list[float | None]:
    source, _ = open_source(file)
    names = [
        next((n for n in (f"temperature_{i}", f"temperature_{joint}") if n in source.names), None)
        for i, joint in enumerate(joints)
    ]
    wanted = [n for n in names if n is not None]
    if not wanted:
        return [None] * len(joints)
    table = source.read(wanted, None)
    return [None if n is None else _mean(table.numbers[n]) for n in names]


def _mean(values: Any) -> float | None:
    finite = np.asarray(values, dtype=float)
    finite = finite[np.isfinite(finite)]
    return float(finite.mean()) if finite.size else None
