"""The nominal model of `lagnet diagnose --simulated`: learned from the simulator's own recordings."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from lagnet.cli.shared.console import say
from lagnet.percent import percent

if TYPE_CHECKING:
    from lagnet.recordings.recording import Recording


def nominal_from(
    paths: Sequence[Path], columns: Path | None, constants: list[float] | None, seed: int
) -> tuple[Any, np.ndarray, list[Recording]]:
    """The learned model, the torque that it is known to miss, shape (dof,) [N m], and the simulated recordings."""
    from lagnet.diagnosis.nominal.from_recordings import learn_nominal
    from lagnet.recordings.loading.load import load_recording

    read = [load_recording(path, columns=columns, torque_constant=constants) for path in paths]
    say(f"learning the simulator's arm from {len(read)} recordings")
    learned = learn_nominal(read, seed=seed)
    say(f"learned as {learned.kind}; held-out error {percent(float(np.max(learned.share)))} at its worst joint")
    return learned.model, learned.error, read
