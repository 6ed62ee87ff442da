"""A second look in a narrower band where much is unexplained: impacts and resonances drown what holds below them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from lagnet.diagnosis.spells import Spell, set_aside
from lagnet.errors import DiagnosisError
from lagnet.models.corrected import torque_with

if TYPE_CHECKING:
    from lagnet.diagnosis.inquiry import Inquiry

PUZZLING = 0.3  # of a joint's mismatch: left unexplained, it is reason enough to look again
CLEARLY = 2.0  # times the noise that it must exceed
FACTORS = (0.5, 0.25)  # of the bandwidth
LEAST = 2.5  # [Hz]
BETTER = np.log(3.0)  # by which the held-out errors of all joints together must fall: one joint's to a third


def best_band(first: Inquiry, at: Callable[[float], Inquiry]) -> Inquiry:
    """The inquiry, or the one in a narrower band that predicts held-out torque much better below that band.

    Args:
        at: an inquiry into the same recordings at a given bandwidth [Hz].
    """
    if not is_puzzled(first):
        return first
    tried = [first, *_narrower(first.fit.bandwidth, at)]
    spells = [s for one in tried for s in one.spells]
    errors = [_error(one, tried[-1], spells) for one in tried]
    best = int(np.argmin(errors))
    return tried[best] if errors[best] < errors[0] - BETTER else first


def is_puzzled(inquiry: Inquiry) -> bool:
    """Whether some joint keeps much of its mismatch, clearly above the noise."""
    limits = (CLEARLY * inquiry.noise) ** 2
    left = zip(inquiry.leftovers, limits, strict=True)
    return any(joint.above and joint.share > PUZZLING and joint.power > limit for joint, limit in left)


def _narrower(bandwidth: float, at: Callable[[float], Inquiry]) -> list[Inquiry]:
    out = []
    for band in (f * bandwidth for f in FACTORS):
        if band < LEAST:
            break
        try:
            out.append(at(band))
        except DiagnosisError:  # recordings too short for so slow a filter
            break
    return out


def _error(inquiry: Inquiry, judge: Inquiry, spells: Sequence[Spell]) -> float:
    """Logarithm of the held-out errors of all joints in the band of another inquiry, noise being the least.

    Intervals in which something acts that no inquiry has a name for count for none.
    """
    clean = set_aside(judge.problem, spells)
    problem = replace(clean, slow=inquiry.problem.slow, straight=inquiry.problem.straight, held=inquiry.problem.held)
    rest, counts = [], []
    for piece in problem.holdout:
        motion = replace(piece.motion(problem), recorded=None)
        rest.append(problem.reduce(piece, piece.tau - torque_with(motion, inquiry.effects)) * piece.counts)
        counts.append(piece.counts)
    power = np.sum(np.concatenate(rest) ** 2, axis=0) / np.maximum(1, np.concatenate(counts).sum(axis=0))
    return float(np.sum(np.log(np.maximum(power, np.maximum(judge.noise, 1e-12) ** 2))))
