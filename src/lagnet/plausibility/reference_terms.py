"""Both models on the same motion: the recordings' where there are any, else random configurations."""

from __future__ import annotations

import numpy as np

from lagnet.decomposition.agreement import Agreement, agreement, blocks_of, variance_floor
from lagnet.decomposition.motion_of import motion_of
from lagnet.decomposition.offers import offers
from lagnet.decomposition.terms import Terms, terms_of
from lagnet.plausibility.check import Finding, NotApplicable
from lagnet.plausibility.subject import Subject

SAMPLES = 1000
MOST = 5000  # samples of recordings that are compared, evenly spread
RIGID, LEARNED = 1e-12, 0.05


def term_limit(subject: Subject) -> float:
    """Two models made of bodies must agree to rounding; a learned one may miss 5 % of a term's variance."""
    made_of_bodies = subject.offers("inertial_parameters") and hasattr(subject.reference, "inertial_parameters")
    return RIGID if made_of_bodies else LEARNED


def has_residual(subject: Subject) -> bool:
    """Whether the reference says what lies beyond mechanics; one that does not has nothing to compare ε with."""
    return subject.reference is not None and offers(subject.reference, "residual_torque")


def compare(subject: Subject, term: str) -> Finding:
    """Worst joint of one term of the torque, its nMSE and 95 % interval.

    Raises:
        NotApplicable: there is no reference.
    """
    if subject.reference is None:
        raise NotApplicable("no reference was given")
    q, v, a, blocks = _motion(subject)
    own, believed = terms_of(_Guarded(subject), q, v, a), terms_of(subject.reference, q, v, a)
    found = _agreement(own, believed, term, blocks, subject.seed)
    joint = int(np.argmax(found.nmse))
    interval = "" if np.isnan(found.low[joint]) else f" (95 % {found.low[joint]:.3g} … {found.high[joint]:.3g})"
    others = ", ".join(f"{x:.2g}" for x in found.nmse)
    off = np.abs(getattr(own, term) - getattr(believed, term))[:, joint]
    k = int(np.argmax(off))
    where = {"joint": subject.joints[joint], "q": q[k].tolist(), "v": v[k].tolist(), "a": a[k].tolist()}
    detail = (
        f"{term} torque of {subject.joints[joint]} differs by up to {off[k]:.3g} N m{interval}; nMSE of all joints "
    )
    return Finding(float(found.nmse[joint]), where, detail + f"{others}; worst")


def _agreement(own: Terms, believed: Terms, term: str, blocks: np.ndarray, seed: int) -> Agreement:
    floor = variance_floor(believed.total)
    return agreement(getattr(own, term), getattr(believed, term), floor, blocks, seed)


def _motion(subject: Subject) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    if not subject.recordings:
        q, v, a = subject.random(SAMPLES, salt=12)
        return q, v, a, np.arange(SAMPLES)
    parts, blocks, used = [], [], 0
    every = max(1, sum(len(r) for r in subject.recordings) // MOST)
    for recording in subject.recordings:
        q, v, a, _ = motion_of(recording)
        parts.append([x[::every] for x in (q, v, a)])
        number = blocks_of(recording.time, recording.trajectory)[::every]
        blocks.append(used + np.unique(number, return_inverse=True)[1])
        used = int(blocks[-1].max()) + 1
    q, v, a = (np.concatenate(x) for x in zip(*parts, strict=True))
    return q, v, a, np.concatenate(blocks)


class _Guarded:
    """The model under examination, called through its subject."""

    def __init__(self, subject: Subject):
        self.mass_matrix, self.coriolis_torque = subject.mass_matrix, subject.coriolis_torque
        self.gravity_torque, self.inverse_dynamics = subject.gravity_torque, subject.torque
        if subject.offers("residual_torque"):
            self.residual_torque = subject.residual
