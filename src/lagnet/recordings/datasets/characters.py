"""A simulated two-link arm that writes letters, with the true parts of its torque."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lagnet.errors import RecordingError
from lagnet.recordings.loading.load import load_recording
from lagnet.recordings.readers.npz_file import NpzArchive
from lagnet.recordings.recording import Recording
from lagnet.types import MassMatrix, Trajectory

N_DOF = 2
TEST_LETTERS = ("e", "q", "v")  # held out by the papers that use these data


@dataclass(frozen=True, eq=False)
class Characters:
    """Motions of twenty letters and the truth behind their torques.

    Args:
        recording: one trajectory a letter, named by it.
        inertial_torque: shape (n, 2), M(q) a [N m].
        coriolis_torque: shape (n, 2), C(q, v) v [N m].
        gravity_torque: shape (n, 2), g(q) [N m].
        mass_matrix: shape (n, 2, 2), M(q) [kg m²].
    """

    recording: Recording
    inertial_torque: Trajectory
    coriolis_torque: Trajectory
    gravity_torque: Trajectory
    mass_matrix: MassMatrix

    def letters(self, names: tuple[str, ...]) -> np.ndarray:
        """Mask of the samples that belong to these letters, shape (n,)."""
        wanted = [i for i, name in enumerate(self.recording.trajectory_names) if name in names]
        return np.isin(self.recording.trajectory, wanted)


def load_characters(path: str | Path) -> Characters:
    """Read characters.npz: motion, torque and its parts, with offsets that cut the rows into letters.

    Raises:
        RecordingError: not such a file.

    Source: Lutter, Ritter and Peters 2019, Deep Lagrangian Networks.
    """
    recording = load_recording(path, n_dof=N_DOF)
    archive = NpzArchive(Path(path).read_bytes(), str(path))
    truth = {}
    for name in ("inertial_torque", "coriolis_torque", "gravity_torque", "mass_matrix"):
        shape = (len(recording), N_DOF, N_DOF)[: 3 if name == "mass_matrix" else 2]
        if archive.shapes.get(name) != shape:
            raise RecordingError(f"array {name} is not of shape {shape}", where=str(path))
        truth[name] = archive.array(name)
    return Characters(recording, **truth)
