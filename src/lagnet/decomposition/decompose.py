"""Where the torque goes: a model's terms along recordings, against a reference and against what was measured."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from lagnet.decomposition.agreement import Agreement, agreement, blocks_of, variance_floor
from lagnet.decomposition.energies import Energies, energies_of
from lagnet.decomposition.ensemble import Spread, spread_of
from lagnet.decomposition.motion_of import motion_of
from lagnet.decomposition.terms import Terms, terms_of
from lagnet.errors import ModelError, RecordingError
from lagnet.recordings.recording import Recording
from lagnet.types import JointVector, Samples, Trajectory


@dataclass(frozen=True, eq=False)
class Decomposition:
    """The torque of a model along recordings, split by cause.

    Args:
        joints: joint names; joint_types: 'revolute', 'continuous' or 'prismatic'.
        time: shape (n,), [s], of the recordings one after the other.
        recording: shape (n,), number of the recording that a sample is from; trajectory: of the motion.
        sources: name of each recording.
        q, v, a: shape (n, dof), motion at the samples; motion_from: "recorded" or "differentiated".
        measured: shape (n, dof), recorded torque [N m].
        terms: the model's torque, split; of the mean of an ensemble.
        reference: the same of a model that is believed, or None.
        energies: of the model along the motion.
        total_error: nMSE of the total against what was measured.
        term_errors: nMSE of each term against the reference's, by name; empty without one.
        spread: how far the members of an ensemble differ, None for a single model.
    """

    joints: tuple[str, ...]
    joint_types: tuple[str, ...]
    time: Samples
    recording: np.ndarray
    trajectory: np.ndarray
    sources: tuple[str, ...]
    q: Trajectory
    v: Trajectory
    a: Trajectory
    motion_from: str
    measured: Trajectory
    terms: Terms
    reference: Terms | None
    energies: Energies
    total_error: Agreement
    term_errors: Mapping[str, Agreement]
    spread: Spread | None = None

    @property
    def n_dof(self) -> int:
        """Number of joints."""
        return len(self.joints)

    @property
    def shares(self) -> dict[str, JointVector]:
        """Share of each term in the power of the whole torque, each of shape (dof,).

        ⟨term · total⟩ / ⟨total²⟩: the four add up to one; a term that works against the others has a negative share.
        """
        total = self.terms.total
        power = np.maximum(np.mean(total**2, axis=0), 1e-300)
        return {name: np.mean(term * total, axis=0) / power for name, term in self.terms.items() if name != "total"}


def decompose(
    model: Any, recording: Recording | Sequence[Recording], reference: Any | None = None, seed: int = 0
) -> Decomposition:
    """Says how much of each joint's torque is inertia, Coriolis, gravity and the rest.

    Args:
        model: anything with the calls of lagnet.types.InverseDynamics, or a sequence of such models (an ensemble).
        recording: one recording or several of the same arm.
        reference: a model that is believed, to compare term by term.
        seed: of the resampling behind the intervals.

    Raises:
        ModelError: model, reference and recording have different numbers of joints.
        RecordingError: no recording, or one too short to differentiate.
    """
    models = tuple(model) if isinstance(model, Sequence) else (model,)
    recordings = (recording,) if isinstance(recording, Recording) else tuple(recording)
    _refuse_strangers(models, recordings, reference)
    motion = _Motion.of(recordings)
    split = [terms_of(m, motion.q, motion.v, motion.a, motion.time, motion.trajectory) for m in models]
    terms, spread = spread_of(split)
    believed = None
    if reference is not None:
        believed = terms_of(reference, motion.q, motion.v, motion.a, motion.time, motion.trajectory)
    blocks = blocks_of(motion.time, motion.trajectory)
    clock = motion.time, motion.trajectory
    return Decomposition(
        joints=tuple(models[0].joints),
        joint_types=_joint_types(models[0], reference),
        time=motion.time,
        recording=motion.recording,
        trajectory=motion.trajectory,
        sources=tuple(r.path or f"recording {i}" for i, r in enumerate(recordings)),
        q=motion.q,
        v=motion.v,
        a=motion.a,
        motion_from=motion.source,
        measured=motion.tau,
        terms=terms,
        reference=believed,
        energies=energies_of(models, *clock, motion.q, motion.v, terms, motion.tau),
        total_error=agreement(terms.total, motion.tau, variance_floor(motion.tau), blocks, seed),
        term_errors=_errors(terms, believed, blocks, seed),
        spread=spread,
    )


@dataclass(frozen=True, eq=False)
class _Motion:
    """Recordings one after the other."""

    time: Samples
    q: Trajectory
    v: Trajectory
    a: Trajectory
    tau: Trajectory
    recording: np.ndarray
    trajectory: np.ndarray
    source: str

    @staticmethod
    def of(recordings: Sequence[Recording]) -> _Motion:
        parts = [motion_of(r) for r in recordings]
        q, v, a = (np.concatenate([part[k] for part in parts]) for k in range(3))
        count, trajectory = 0, []
        for r in recordings:
            trajectory.append(r.trajectory + count)
            count += int(r.trajectory.max()) + 1
        sources = {part[3] for part in parts}
        return _Motion(
            np.concatenate([r.time for r in recordings]),
            q,
            v,
            a,
            np.concatenate([r.torque for r in recordings]),
            np.repeat(np.arange(len(recordings)), [len(r) for r in recordings]),
            np.concatenate(trajectory),
            sources.pop() if len(sources) == 1 else "recorded and differentiated",
        )


def _errors(terms: Terms, believed: Terms | None, blocks: np.ndarray, seed: int) -> dict[str, Agreement]:
    if believed is None:
        return {}
    floor, true = variance_floor(believed.total), dict(believed.items())
    return {name: agreement(term, true[name], floor, blocks, seed) for name, term in terms.items()}


def _joint_types(model: Any, reference: Any | None) -> tuple[str, ...]:
    for source in (model, reference):
        if source is not None and hasattr(source, "joint_types"):
            return tuple(source.joint_types)
    return ("revolute",) * model.n_dof


def _refuse_strangers(models: Sequence[Any], recordings: Sequence[Recording], reference: Any | None) -> None:
    if not recordings or not models:
        raise RecordingError("no recording was given" if models else "no model was given")
    n = models[0].n_dof
    for what, other in (*(("model", m) for m in models), ("reference", reference), *(("", r) for r in recordings)):
        if other is not None and other.n_dof != n:
            where = what or other.path or "recording"
            raise ModelError(f"has {other.n_dof} joints, the model {n}", where=where, next_step="give the same arm")
