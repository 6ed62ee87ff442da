"""Writes what a diagnosis promises: verdict.json, holdout_torque.parquet and the corrected model."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from lagnet.diagnosis.diagnose import Diagnosis
from lagnet.diagnosis.prediction import torque_at_samples
from lagnet.models.corrected_files import save_corrected


def write_diagnosis(diagnosis: Diagnosis, folder: str | Path) -> Path:
    """Writes verdict.json, holdout_torque.parquet and corrected/ into a folder.

    Returns:
        The folder.
    """
    out = Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    pq.write_table(holdout_table(diagnosis), out / "holdout_torque.parquet")
    save_corrected(diagnosis.corrected, out / "corrected")
    (out / "verdict.json").write_text(diagnosis.to_json(), encoding="utf-8")
    return out


def holdout_table(diagnosis: Diagnosis) -> pa.Table:
    """Measured, nominal and corrected torque at every held-out sample as given."""
    columns: dict[str, list[np.ndarray]] = {}
    names: list[str] = []
    for index, recording in enumerate(diagnosis.holdout_recordings):
        corrected = replace(diagnosis.corrected, recording=diagnosis.ends_of[index])
        parts = {
            "measured": recording.tau,
            "nominal": torque_at_samples(diagnosis.corrected.nominal, recording, diagnosis.conditioned_holdout, index),
            "corrected": torque_at_samples(corrected, recording, diagnosis.conditioned_holdout, index),
        }
        columns.setdefault("time", []).append(recording.time)
        for joint in range(recording.n_dof):
            for kind, torque in parts.items():
                columns.setdefault(f"tau_{kind}_{joint}", []).append(torque[:, joint])
        names.extend([recording.path or f"recording {index + 1}"] * len(recording))
    table = {name: np.concatenate(parts) for name, parts in columns.items()}
    if len(diagnosis.holdout_recordings) > 1:
        return pa.table(table | {"recording": names})
    return pa.table(table)
