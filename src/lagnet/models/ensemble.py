"""Several learned models of one arm asked together: their mean, how far they disagree, and a band around the torque.

Models that were trained alike but for their seed agree where the recordings determined the torque and disagree where
they did not. The disagreement alone is no interval: errors that all share do not show in it. A `Band` therefore widens
it to what held-out torque showed, joint by joint.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple, final

import numpy as np

from lagnet.errors import ModelError
from lagnet.models.learned_model import LearnedModel
from lagnet.types import MassMatrix, Trajectory

SOLVES = 4  # passes of forward dynamics; one is exact where ε does not depend on the acceleration


class TorqueBand(NamedTuple):
    """Torque of shape (n, dof) [N m]: lower end, mean of the members, upper end."""

    low: Trajectory
    mean: Trajectory
    high: Trajectory


@dataclass(frozen=True)
class Band:
    """How wide a band must be: factor · √(spread² + floor²), joint by joint.

    Args:
        coverage: share of held-out torque samples inside, 0 … 1.
        factor: of each joint [-]; floor: error of each joint that no disagreement shows [N m].
    """

    coverage: float
    factor: tuple[float, ...]
    floor: tuple[float, ...]

    def width(self, spread: Trajectory) -> Trajectory:
        """Half width of the band [N m] for the spread of the members, both of shape (n, dof)."""
        return np.asarray(self.factor) * np.hypot(spread, np.asarray(self.floor))


def calibrated(error: Trajectory, spread: Trajectory, coverage: float) -> Band:
    """The band that holds a share of held-out torque on each joint.

    Args:
        error: held-out torque less the mean of the members; spread: their disagreement there; both (n, dof) [N m].
        coverage: the share, between 0 and 1.

    Raises:
        ModelError: a coverage outside, or more than so few samples can show.
    """
    n = len(error)
    rank = int(np.ceil((n + 1) * coverage))  # split conformal: holds for the next sample too, not only for these
    if not 0.0 < coverage < 1.0 or rank > n:
        raise ModelError(f"coverage {coverage} cannot be told from {n} samples", next_step="give 0.5 … 0.95")
    floor = np.maximum(np.sqrt(np.mean(error**2, axis=0)), 1e-12)
    score = np.sort(np.abs(error) / np.hypot(spread, floor), axis=0)
    return Band(coverage, tuple(score[rank - 1].tolist()), tuple(floor.tolist()))


@final
class Ensemble:
    """The mean of learned models, an `InverseDynamics`, and the band around its torque.

    Args:
        members: two or more models of the same joints.
        band: its width; from `lagnet.training.ensemble` or `calibrated`.

    Raises:
        ModelError: fewer than two members, or different joints.
    """

    compiles = True  # its members are

    def __init__(self, members: Sequence[LearnedModel], band: Band, source: str = ""):
        if len(members) < 2 or any(m.joints != members[0].joints for m in members):
            raise ModelError("an ensemble needs two or more models of the same joints")
        self.members, self.band, self.source = tuple(members), band, source
        self.joints, self.joint_types = members[0].joints, members[0].joint_types
        self.kind, self.model_kind = "ensemble", members[0].model_kind

    def __repr__(self) -> str:
        return f"Ensemble({len(self.members)} x {self.model_kind}, {self.n_dof} joints: {', '.join(self.joints)})"

    @property
    def n_dof(self) -> int:
        """Number of joints."""
        return len(self.joints)

    def inverse_dynamics(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """Torque [N m] that gives acceleration a at (q, v), shape (n, dof)."""
        return self._mean("inverse_dynamics", q, v, a)

    def spread(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """Standard deviation of the members' torques, shape (n, dof) [N m]."""
        return self._all("inverse_dynamics", q, v, a).std(axis=0, ddof=1)

    def torque_band(self, q: Trajectory, v: Trajectory, a: Trajectory) -> TorqueBand:
        """Torque and the ends of its band; wider where the members disagree."""
        found = self._all("inverse_dynamics", q, v, a)
        mean, width = found.mean(axis=0), self.band.width(found.std(axis=0, ddof=1))
        return TorqueBand(mean - width, mean, mean + width)

    def forward_dynamics(self, q: Trajectory, v: Trajectory, tau: Trajectory) -> Trajectory:
        """Acceleration that torque tau gives at (q, v), shape (n, dof): what `inverse_dynamics` undoes."""
        mass, a = self.mass_matrix(q), np.zeros_like(np.asarray(tau, dtype=np.float64))
        for _ in range(SOLVES):
            missing = tau - self.inverse_dynamics(q, v, a)
            a = a + np.linalg.solve(mass, missing[..., None])[..., 0]
        return a

    def mass_matrix(self, q: Trajectory) -> MassMatrix:
        """Joint-space inertia H(q), shape (n, dof, dof)."""
        return self._mean("mass_matrix", q)

    def coriolis_matrix(self, q: Trajectory, v: Trajectory) -> MassMatrix:
        """Christoffel matrix of the mean H, shape (n, dof, dof)."""
        return self._mean("coriolis_matrix", q, v)

    def coriolis_torque(self, q: Trajectory, v: Trajectory) -> Trajectory:
        """Centrifugal and Coriolis torques c(q, v), shape (n, dof) [N m]."""
        return self._mean("coriolis_torque", q, v)

    def gravity_torque(self, q: Trajectory) -> Trajectory:
        """Torque that holds the arm still, shape (n, dof) [N m]."""
        return self._mean("gravity_torque", q)

    def residual_torque(self, q: Trajectory, v: Trajectory, a: Trajectory) -> Trajectory:
        """What H a + c + g leave of the whole torque, shape (n, dof) [N m]."""
        return self._mean("residual_torque", q, v, a)

    def save(self, folder: str | Path) -> Path:
        """Write all members and the band to a folder, without pickle; see `lagnet.models.files.ensemble_files`."""
        from lagnet.models.files.ensemble_files import save_ensemble

        return save_ensemble(self, folder)

    def _all(self, name: str, *given: Any) -> np.ndarray:
        return np.stack([getattr(member, name)(*given) for member in self.members])

    def _mean(self, name: str, *given: Any) -> np.ndarray:
        return self._all(name, *given).mean(axis=0)
