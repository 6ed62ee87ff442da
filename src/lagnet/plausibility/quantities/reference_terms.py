"""Both models on the same motion: the recordings' where there are any, else random configurations."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from lagnet.decomposition.agreement import Agreement, agreement, blocks_of, variance_floor
from lagnet.decomposition.motion_of import motion_of
from lagnet.decomposition.offers import offers
from lagnet.decomposition.terms import Terms, terms_of
from lagnet.errors import ModelError
from lagnet.plausibility.calling import NotFinite
from lagnet.plausibility.check import Finding, NotApplicable, place
from lagnet.plausibility.search import worst_configuration
from lagnet.plausibility.subject import CALLS, Subject

Call = Callable[..., np.ndarray]

SYMBOLS = {"inertial": "qa", "coriolis": "qv", "gravity": "q", "residual": "qva", "total": "qva"}
CALL_OF = {
    "coriolis": "coriolis_torque",
    "gravity": "gravity_torque",
    "residual": "residual_torque",
    "total": "inverse_dynamics",
}
SAMPLES = 1000
MOST = 5000  # samples of recordings that are compared, evenly spread
RIGID, LEARNED = 1e-12, 0.05


def term_limit(subject: Subject) -> float:
    """Two models made of bodies must agree to rounding; a learned one may miss 5 % of a term's variance."""
    made_of_bodies = subject.offers("inertial_parameters") and offers(subject.reference, "inertial_parameters")
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
    own, believed = _Guarded(subject.model, subject.call), _Guarded(subject.reference, _call_of_reference(subject))
    found = _agreement(terms_of(own, q, v, a), terms_of(believed, q, v, a), term, blocks, subject.seed)
    joint = int(np.argmax(found.nmse))
    off, where = _farthest_apart(subject, own, believed, term, joint, (q, v, a))
    detail = f"{term} torque of {subject.joints[joint]} differs by up to {off:.3g} {subject.unit('tau', joint)}; nMSE"
    if not np.isnan(found.low[joint]):
        detail += f" (95 % {found.low[joint]:.3g} … {found.high[joint]:.3g})"
    every = zip(subject.joints, found.nmse.tolist(), found.low.tolist(), found.high.tolist(), strict=True)
    joints = tuple({"joint": name, "value": value, "ci95": [low, high]} for name, value, low, high in every)
    return Finding(float(found.nmse[joint]), {"joint": subject.joints[joint], **where}, detail, joints=joints)


def _farthest_apart(
    subject: Subject, own: _Guarded, believed: _Guarded, term: str, joint: int, motion: tuple[np.ndarray, ...]
) -> tuple[float, dict[str, Any]]:
    """Where the torques of a joint differ most, on the motion compared and by search around it."""

    def apart(*at: np.ndarray) -> np.ndarray:
        motion = dict(zip(symbols, at, strict=True))
        return np.abs(own.term(term, motion) - believed.term(term, motion))[:, joint]

    symbols = SYMBOLS[term]
    at = [x for symbol, x in zip("qva", motion, strict=True) if symbol in symbols]
    seen = apart(*at)
    k = int(np.argmax(seen))
    worst, where = worst_configuration(subject, symbols, apart)
    if seen[k] >= worst.value:
        return float(seen[k]), {symbol: x[k].tolist() for symbol, x in zip(symbols, at, strict=True)}
    return worst.value, where


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


def _call_of_reference(subject: Subject) -> Call:
    def call(name: str, *arrays: np.ndarray) -> np.ndarray:
        try:
            return subject.believed.call(name, *arrays)
        except NotFinite as found:
            raise ModelError(
                f"{found.call} of the reference gives a number that is not finite",
                where=place(found.where).removeprefix(" at "),
                next_step="check the reference by itself first",
            ) from None

    return call


class _Guarded:
    """The calls of a model that the terms are made from, each made with care."""

    def __init__(self, model: Any, call: Call):
        for name in CALLS:
            setattr(self, name, partial(call, name))
        self._call, self._has_residual = call, offers(model, "residual_torque")
        if self._has_residual:
            self.residual_torque = partial(call, "residual_torque")

    def term(self, name: str, motion: Mapping[str, np.ndarray]) -> np.ndarray:
        """One term of the torque, shape (n, dof), from those of q, v, a that it depends on."""
        if name == "inertial":
            return np.einsum("nij,nj->ni", self._call("mass_matrix", motion["q"]), motion["a"])
        if name == "residual" and not self._has_residual:
            return terms_of(self, *motion.values()).residual
        return self._call(CALL_OF[name], *motion.values())
