"""Named arrays (of .npz and .mat files) seen as a table: `q` of shape (n, dof) becomes the columns q_0, q_1, …"""

from __future__ import annotations

import numpy as np

from lagnet.errors import RecordingError
from lagnet.recordings.signals import JOINT_SIGNALS

MOST_COLUMNS = 20_000  # of all arrays together


def columns_of(shapes: dict[str, tuple[int, ...]]) -> dict[str, tuple[str, int | None]]:
    """Column name to (array, index of its column); None for an array that is one column itself.

    Args:
        shapes: shape of every array in the file. Arrays of more than two dimensions are no columns.
    """
    found: dict[str, tuple[str, int | None]] = {}
    for name, shape in shapes.items():
        if len(shape) == 1 or (len(shape) == 2 and 1 in shape):
            found[f"{name}_0" if name in JOINT_SIGNALS else name] = (name, None)
        elif len(shape) == 2:
            if len(found) + shape[1] > MOST_COLUMNS:
                raise RecordingError(
                    f"{name} has {shape[1]} columns, at most {MOST_COLUMNS} are read",
                    next_step="give arrays of shape (n_samples, n_dof), not the other way round",
                )
            found |= {f"{name}_{i}": (name, i) for i in range(shape[1])}
    return found


def column(array: np.ndarray, index: int | None) -> np.ndarray:
    """One column of an array, shape (n,)."""
    return np.asarray(array).reshape(-1) if index is None else np.asarray(array)[:, index]


def expand_offsets(offsets: np.ndarray, labels: np.ndarray | None, n_rows: int, where: str) -> np.ndarray:
    """Trajectory label of every row from the rows at which trajectories begin.

    Args:
        offsets: shape (k + 1,), first row of each of k trajectories, and the number of rows at its end.
        labels: shape (k,), their names, or None for 0 … k-1.
        n_rows: number of rows of the file.

    Raises:
        RecordingError: offsets that do not cut the rows into pieces.
    """
    lengths = np.diff(offsets)
    if offsets.dtype.kind not in "iu" or offsets[0] != 0 or offsets[-1] != n_rows or (lengths <= 0).any():
        raise RecordingError(
            f"offsets do not cut the {n_rows} rows into trajectories",
            where=where,
            next_step=f"give increasing row numbers from 0 to {n_rows}",
        )
    names = np.arange(lengths.size) if labels is None else labels
    if names.size != lengths.size:
        raise RecordingError(f"{names.size} labels for {lengths.size} trajectories", where=where)
    return np.repeat(names, lengths)
