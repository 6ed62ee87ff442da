"""The SARCOS arm's samples: 28 columns (7 q, 7 v, 7 a, 7 torques), shuffled, without time."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np

from lagnet.errors import RecordingError
from lagnet.recordings.readers.mat_file import MatArrays
from lagnet.recordings.readers.source import refuse_if_huge
from lagnet.recordings.recording import Recording

N_DOF = 7
COLUMNS = 4 * N_DOF
JOINTS = tuple(f"joint_{i}" for i in range(N_DOF))


def load_sarcos(path: str | Path) -> Recording:
    """Read SARCOS samples; each is a trajectory of its own, since neighbouring rows are not neighbours in time.

    `time` counts the rows and means nothing else: no filter, derivative or stretch of time may be taken over it, and
    the one-sample trajectories see to that. The two public files overlap: nearly all rows of the test file
    are also in the training file, so a score on the test file after training on the other measures memory.

    Args:
        path: sarcos_inv.mat or sarcos_inv_test.mat.

    Returns:
        q [rad], v [rad/s], a [rad/s²] and tau of shape (n, 7).

    Raises:
        RecordingError: no such file, or no array of 28 finite columns in it.

    Source: Vijayakumar and Schaal 2000, data of the book by Rasmussen and Williams 2006.
    """
    path, where = Path(path), str(path)
    if not path.is_file():
        raise RecordingError("does not exist", where=where, next_step="get it with lagnet data fetch sarcos")
    refuse_if_huge(path.stat().st_size, where)
    data = path.read_bytes()
    arrays = MatArrays(data, where)
    found = [name for name, shape in arrays.shapes.items() if len(shape) == 2 and shape[1] == COLUMNS]
    if len(found) != 1:
        raise RecordingError(f"holds {len(found)} arrays of {COLUMNS} columns, expected one", where=where)
    samples = arrays.array(found[0]).astype(np.float64)
    bad = np.argwhere(~np.isfinite(samples))
    if bad.size:
        raise RecordingError(f"row {bad[0][0] + 1}, column {bad[0][1] + 1}: not a finite number", where=where)
    q, v, a, tau = np.split(samples, 4, axis=1)
    n = len(samples)
    return Recording(
        time=np.arange(n, dtype=np.float64),
        q=q,
        tau=tau,
        joints=JOINTS,
        v=v,
        a=a,
        trajectory=np.arange(n),
        trajectory_names=tuple(map(str, range(n))),
        path=where,
        sha256=hashlib.sha256(data).hexdigest(),
        warnings=("shuffled samples without time: time counts the rows",),
    )
