"""Bodies that no matter makes.

A strut or a balancing spring pulls like a first moment of its link that comes without rotational inertia. As a body
that is much mass close to the axis: the link as changed would have to be denser than any element.
"""

from __future__ import annotations

from collections.abc import Sequence

from lagnet.diagnosis.arm_search import Found
from lagnet.diagnosis.fitting import Workbench
from lagnet.diagnosis.nearest_body import body_before
from lagnet.diagnosis.problem import Problem
from lagnet.diagnosis.settle import without
from lagnet.models.corrected import NamedEffect
from lagnet.rigid_body.inertia import least_density

DENSEST = 22.6e3  # [kg/m³] osmium, the densest element
GROWN = 2.0  # times the mass of the modelled link: below that, it is the model's body that is dense


def drop_too_dense(problem: Problem, bench: Workbench, found: Found, effects: Sequence[NamedEffect]) -> Found:
    """The selection less the first link whose changed body no matter makes; the same where there is none.

    Args:
        problem: what was measured and modelled.
        bench: the hypotheses fitted.
        found: the selection.
        effects: its effects as refitted, in the order of the selection.
    """
    for index, effect in zip(found.selection, effects, strict=True):
        if effect.effect == "link_inertia" and _is_too_dense(problem, effect):
            return without(bench, found, index)
    return found


def _is_too_dense(problem: Problem, effect: NamedEffect) -> bool:
    before = body_before(problem, effect)
    after = before + effect.coordinates()[: before.size]
    return bool(after[0] > GROWN * before[0] and least_density(after) > DENSEST)
