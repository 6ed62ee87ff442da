"""Files of a diagnosis on motion: verdict.json, holdout_motion.parquet and the corrected model."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from lagnet.diagnosis.motion.diagnose import MotionDiagnosis
from lagnet.files import write_folder_whole, write_whole
from lagnet.models.corrected.servo_files import save_servo_driven


def write_motion_diagnosis(diagnosis: MotionDiagnosis, folder: str | Path) -> Path:
    """Writes verdict.json, holdout_motion.parquet and corrected/ into a folder, each whole or not at all.

    Returns:
        The folder.
    """
    out = Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    verdict, table = diagnosis.to_json(), io.BytesIO()
    pq.write_table(holdout_motion_table(diagnosis), table)
    write_folder_whole(out / "corrected", lambda made: save_servo_driven(diagnosis.corrected, made))
    write_whole(out / "holdout_motion.parquet", table.getvalue())
    write_whole(out / "verdict.json", verdict)
    return out


def holdout_motion_table(diagnosis: MotionDiagnosis) -> pa.Table:
    """Measured, nominal and corrected positions at every held-out sample, rolled out from each first sample alone."""
    columns: dict[str, list[np.ndarray]] = {}
    names: list[str] = []
    parts = [(r, i, p) for i, r in enumerate(diagnosis.holdout_recordings) for p in r.parts()]
    for k, (recording, index, part) in enumerate(parts):
        kinds = {
            "measured": np.array(part.q),
            "nominal": diagnosis.nominal_rollouts[k],
            "corrected": diagnosis.corrected_rollouts[k],
        }
        columns.setdefault("time", []).append(part.time)
        for joint in range(recording.n_dof):
            for kind, q in kinds.items():
                columns.setdefault(f"q_{kind}_{joint}", []).append(q[:, joint])
        names.extend([recording.path or f"recording {index + 1}"] * len(part))
    return pa.table({"recording": names} | {name: np.concatenate(values) for name, values in columns.items()})
