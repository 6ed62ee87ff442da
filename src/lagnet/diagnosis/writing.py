"""Writes what a diagnosis promises: verdict.json, holdout_torque.parquet and the corrected model."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from lagnet.diagnosis.diagnose import Diagnosis
from lagnet.files import write_folder_whole, write_whole
from lagnet.models.corrected.folder import save_corrected
from lagnet.recordings.recording import Recording


def write_diagnosis(diagnosis: Diagnosis, folder: str | Path) -> Path:
    """Writes verdict.json, holdout_torque.parquet and corrected/ into a folder, each whole or not at all.

    Returns:
        The folder.
    """
    out = Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    verdict, table = diagnosis.to_json(), io.BytesIO()
    pq.write_table(holdout_table(diagnosis), table)
    write_folder_whole(out / "corrected", lambda folder: save_corrected(diagnosis.corrected, folder))
    write_whole(out / "holdout_torque.parquet", table.getvalue())
    write_whole(out / "verdict.json", verdict)
    return out


def holdout_table(diagnosis: Diagnosis) -> pa.Table:
    """Measured torque and that of the nominal model and of each layer, at every held-out sample as given."""
    columns: dict[str, list[np.ndarray]] = {}
    names: list[str] = []
    for index, torque in enumerate(diagnosis.holdout_torques):
        recording = torque.recording
        columns.setdefault("time", []).append(recording.time)
        for joint in range(recording.n_dof):
            for kind, values in ({"measured": recording.torque} | torque.layers).items():
                columns.setdefault(f"tau_{kind}_{joint}", []).append(values[:, joint])
        columns.setdefault("set_aside", []).append(_set_aside(recording))
        names.extend([recording.path or f"recording {index + 1}"] * len(recording))
    table = {name: np.concatenate(parts) for name, parts in columns.items()}
    if not table["set_aside"].any():
        del table["set_aside"]
    if len(diagnosis.holdout_recordings) > 1:
        return pa.table(table | {"recording": names})
    return pa.table(table)


def _set_aside(recording: Recording) -> np.ndarray:
    """Samples that bad data made unusable, shape (n,)."""
    return np.zeros(len(recording), dtype=bool) if recording.valid is None else ~recording.valid
