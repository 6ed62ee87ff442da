"""A decomposition as a table for other programs and a summary for people."""

from __future__ import annotations

import io
import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from lagnet.decomposition.agreement import Agreement
from lagnet.decomposition.decompose import Decomposition
from lagnet.decomposition.energies import work
from lagnet.files import write_whole


def write_decomposition(parts: Decomposition, folder: str | Path) -> Path:
    """Write decomposition.parquet and decomposition.json, each in one step.

    Returns:
        The folder.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    table = io.BytesIO()
    pq.write_table(pa.table(columns(parts)), table)
    write_whole(folder / "decomposition.parquet", table.getvalue())
    text = json.dumps(_finite(summary(parts)), indent=1, allow_nan=False, ensure_ascii=False) + "\n"
    write_whole(folder / "decomposition.json", text)
    return folder


def columns(parts: Decomposition) -> dict[str, np.ndarray]:
    """The table: time, per joint each term, total and measured torque, the reference's beside them, and energies."""
    out: dict[str, np.ndarray] = {"time": parts.time, "recording": parts.recording}
    believed = dict(parts.reference.items()) if parts.reference is not None else {}
    for i in range(parts.n_dof):
        out |= {f"{name}_{i}": term[:, i] for name, term in parts.terms.items()}
        out[f"measured_{i}"] = parts.measured[:, i]
        out |= {f"{name}_{i}_reference": term[:, i] for name, term in believed.items()}
        if parts.spread is not None:
            out |= {f"spread_{name}_{i}": sd[:, i] for name, sd in parts.spread.of.items()}
    energies = parts.energies
    out |= {"kinetic_energy": energies.kinetic, "potential_energy": energies.potential}
    out |= {"measured_power": energies.measured_power, "model_power": energies.model_power}
    return out | {"residual_power": energies.residual_power}


def summary(parts: Decomposition) -> dict[str, Any]:
    """Errors with intervals, shares and energies, by joint."""
    shares = parts.shares
    joints = []
    for i, name in enumerate(parts.joints):
        entry = {
            "joint": name,
            "type": parts.joint_types[i],
            "nmse_total_measured": _interval(parts.total_error, i),
            "share": {term: float(share[i]) for term, share in shares.items()},
            "rms": {term: float(np.sqrt(np.mean(x[:, i] ** 2))) for term, x in parts.terms.items()},
        }
        if parts.term_errors:
            entry["nmse_reference"] = {term: _interval(error, i) for term, error in parts.term_errors.items()}
        joints.append(entry)
    return {
        "schema": "lagnet-decomposition/1",
        "recordings": list(parts.sources),
        "samples": len(parts.time),
        "motion_from": parts.motion_from,
        "ensemble_members": 1 if parts.spread is None else parts.spread.members,
        "joints": joints,
        "energy": _balance(parts),
    }


def _balance(parts: Decomposition) -> dict[str, float]:
    """Work over all motions [J]; the measured work is what the motors gave, up to the model's error."""
    clock, energies = (parts.time, parts.trajectory), parts.energies
    return {
        "measured_work_J": work(*clock, energies.measured_power),
        "model_work_J": work(*clock, energies.model_power),
        "residual_work_J": work(*clock, energies.residual_power),
        "kinetic_energy_largest_J": float(energies.kinetic.max()),
        "potential_energy_range_J": float(np.ptp(energies.potential)),
        "imbalance_largest_J": float(np.abs(energies.imbalance).max()),
    }


def _interval(error: Agreement, i: int) -> dict[str, Any]:
    return {"value": float(error.nmse[i]), "ci95": [float(error.low[i]), float(error.high[i])]}


def _finite(node: Any) -> Any:
    if isinstance(node, dict):
        return {name: _finite(value) for name, value in node.items()}
    if isinstance(node, list):
        return [_finite(value) for value in node]
    return None if isinstance(node, float) and not math.isfinite(node) else node
