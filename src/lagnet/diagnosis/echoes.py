"""Effects that only echo the torque sensor.

A transmission bends under the torque that it carries, and the recorded torque is the best account of that. But it holds
its own noise, whose second derivative is much like the noise itself, so that on recordings with little left out
elasticity may seem to explain noise, or what the form of another law leaves. A prediction sees no recorded torque: what
does nothing there goes, and so does what does much less there than it did with the recorded torque at hand.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.arm_search import Found
from lagnet.diagnosis.evidence_of import HARMLESS
from lagnet.diagnosis.fitting import Workbench
from lagnet.diagnosis.problem import Piece, Problem
from lagnet.diagnosis.prune import refit_and_prune
from lagnet.diagnosis.refit import Refit
from lagnet.diagnosis.settle import without
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected import NamedEffect, torque_with

KEPT = 0.3  # of the error that an effect explains with the recorded torque at hand, that it must explain without


def drop_echoes(problem: Problem, bench: Workbench, found: Found, fitted: Refit) -> tuple[Found, Refit]:
    """The selection less effects of the carried torque that do not help to predict, be it held-out or fitted motion."""
    for index in found.selection:
        if index not in found.selection or not effect_named(bench.library.hypotheses[index].effect).hears_torque:
            continue
        less, refitted = refit_and_prune(problem, bench, without(bench, found, index))
        if any(_is_idle(problem, pieces, fitted, refitted) for pieces in (problem.holdout, problem.fit)):
            found, fitted = less, refitted
    return found, fitted


def _is_idle(problem: Problem, pieces: Sequence[Piece], fitted: Refit, refitted: Refit) -> bool:
    """Whether some pieces are predicted as well by the selection that has one effect less."""
    without_it, with_it = (predicted_error(problem, pieces, fit.effects) for fit in (refitted, fitted))
    heard = [predicted_error(problem, pieces, fit.effects, shown=True) for fit in (refitted, fitted)]
    return without_it < HARMLESS * with_it or without_it - with_it < KEPT * (heard[0] - heard[1])


def predicted_error(
    problem: Problem, pieces: Sequence[Piece], effects: Sequence[NamedEffect], shown: bool = False
) -> float:
    """Mean square of what effects leave in torque that they are (not) shown, in shares of each joint's power."""
    rests = []
    for piece in pieces:
        motion = piece.motion(problem)
        given = motion if shown else replace(motion, recorded=None)
        rests.append(problem.reduce(piece, piece.tau - torque_with(given, effects)) * piece.counts)
    moving = problem.scale > 1e-9 * np.max(problem.scale)
    return float(np.sum(np.mean(np.concatenate(rests)[:, moving] ** 2, axis=0) / problem.scale[moving] ** 2))
