"""The `--mcap` option of `lagnet diagnose`: held-out torques and the verdict for Foxglove, PlotJuggler, Rerun."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lagnet.diagnosis.diagnose import Diagnosis


def write_mcap_of(result: Diagnosis, path: Path) -> Path:
    """Write measured, nominal, corrected and residual torque of the held-out recordings, and the verdict."""
    from lagnet.diagnosis.writing import holdout_table
    from lagnet.recordings.conditioning.condition import motion_at_samples
    from lagnet.reports.mcap_log import logs_of, write_mcap

    held, conditioned = result.holdout_recordings, result.conditioned_holdout
    smoothed = [motion_at_samples(recording, conditioned, index) for index, recording in enumerate(held)]
    motions = [(q, v) for q, v, _ in smoothed]
    joints = held[0].joints
    logs = logs_of(holdout_table(result).to_pydict(), motions, len(joints))
    return write_mcap(path, joints, logs, result.verdict.to_dict())
