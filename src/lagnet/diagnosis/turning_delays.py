"""Delays that are dry friction turning round early or late: a joint whose torque is late is late everywhere.

No dry friction changes its sign in one instant. That of a simulator, solved step by step as a soft constraint, turns
some milliseconds beside the speed, and bristles and seals do likewise.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lagnet.diagnosis.adequacy import left_by
from lagnet.diagnosis.arm_search import Found
from lagnet.diagnosis.evidence_of import HARMLESS
from lagnet.diagnosis.fitting import Workbench
from lagnet.diagnosis.localisation import near_reversal
from lagnet.diagnosis.problem import Problem
from lagnet.diagnosis.settle import without
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected import NamedEffect

DRY = {"coulomb_friction", "load_dependent_friction"}  # and what contains them


def drop_turning_delays(problem: Problem, bench: Workbench, found: Found, effects: Sequence[NamedEffect]) -> Found:
    """The selection less the first delay beside dry friction that helps only where its joint turns; else the same.

    Args:
        problem: what was measured and modelled.
        bench: the hypotheses fitted.
        found: the selection.
        effects: its effects as refitted, in the order of the selection.
    """
    rubs = {e.joint for e in effects if DRY & {e.effect, *effect_named(e.effect).contains}}
    for index, effect in zip(found.selection, effects, strict=True):
        if effect.effect == "time_delay" and effect.joint in rubs and not _helps_between(problem, effect, effects):
            return without(bench, found, index)
    return found


def _helps_between(problem: Problem, delay: NamedEffect, effects: Sequence[NamedEffect]) -> bool:
    """Whether the fit is worse without the delay between the changes of direction of its joint."""
    joint = delay.joint
    assert joint is not None
    between = np.concatenate([~near_reversal(p, joint)[p.keep] for p in problem.fit])
    chosen = (tuple(effects), tuple(e for e in effects if e is not delay))
    with_it, less = (np.sum(left_by(problem, problem.fit, e)[between, joint] ** 2) for e in chosen)
    return bool(less > HARMLESS * with_it)
