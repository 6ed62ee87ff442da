"""How much of the true law's gain in held-out error the named physics reach."""

from __future__ import annotations

import io

import numpy as np
import pyarrow.parquet as pq

from validation.plants.catalogue.plan import Plan


def gain_share(plan: Plan, torques: bytes, beyond: np.ndarray) -> float | None:
    """Gain of the corrected model over the gain of the plant's own noise-free extra torque, all joints.

    Squared errors on every raw held-out sample, in units of each joint's variance. None where the true law gains
    nothing on the held-out motion.

    Args:
        plan: the opened plant.
        torques: content of holdout_torque.parquet.
        beyond: shape (n, dof), what the held-out torque truly has beyond the nominal bodies [N m].
    """
    table = pq.read_table(io.BytesIO(torques)).to_pydict()
    reached = possible = 0.0
    for j in range(beyond.shape[1]):
        measured, nominal, corrected = (np.array(table[f"tau_{k}_{j}"]) for k in ("measured", "nominal", "corrected"))
        power = max(float(np.var(measured)), 1e-12)
        before = np.mean((measured - nominal) ** 2)
        reached += (before - np.mean((measured - corrected) ** 2)) / power
        possible += (before - np.mean((measured - nominal - beyond[:, j]) ** 2)) / power
    return float(reached / possible) if possible > 0 else None
