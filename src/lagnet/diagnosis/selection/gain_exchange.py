"""argmax log P(S ∪ {k} \\ G): one arm-wide hypothesis k in the place of the gains G of several joints.

A heavier link raises the torque of all joints before it, and so do gains of one sign. A body that is fitted beside them
splits the torque with them: τ_body + Σ_j (g_j − 1) τ_j is nearly flat where the load is much like the nominal one. A
search that adds and drops one hypothesis at a time stays there, or at the gains alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.regression.cross_validation import NormalEquations
from lagnet.diagnosis.selection.arm_search import Selection, refit_selection, total_score, views_of
from lagnet.diagnosis.selection.joint_search import improve

GAIN = "torque_gain"
TRIED = 4  # arm-wide effects that are tried in their place


def exchange_gains(equations: NormalEquations, found: Selection) -> Selection:
    """The selection, or one of larger log P without its gains, with one more arm-wide hypothesis or none.

    Where a gain returns beside the bodies, these are not what the gains stood for: a part of the torque alone is split
    another way.
    """
    return max([found, *without_gains(equations, found)], key=lambda one: one.score)


def without_gains(equations: NormalEquations, found: Selection) -> list[Selection]:
    """Selections in the place of one with several gains of one sign, each with one more arm-wide hypothesis or none."""
    gains = _gains(equations, found)
    if len(gains) < 2 or len(set(np.sign(gains))) > 1:
        return []
    bare = _bare(equations, found)
    starts = [bare.arm_wide, *((*bare.arm_wide, i) for i in _instead(equations, bare))]
    tried = [_improved(equations, bare, arm_wide) for arm_wide in starts if arm_wide]
    return [one for one in tried if not _gains(equations, one)]


def _gains(equations: NormalEquations, found: Selection) -> list[float]:
    """g − 1 of every joint that has a gain."""
    chosen = (i for own in found.local for i in own if equations.library.hypotheses[i].effect == GAIN)
    return [float(found.fit.coefficients[i][0]) for i in chosen]


def _bare(equations: NormalEquations, found: Selection) -> Selection:
    """The selection without the gains of single joints, the others fitted anew."""

    def others(own: Sequence[int]) -> tuple[int, ...]:
        return tuple(i for i in own if equations.library.hypotheses[i].effect != GAIN)

    return refit_selection(equations, replace(found, local=tuple(map(others, found.local))))


def _instead(equations: NormalEquations, bare: Selection) -> list[int]:
    """The arm-wide hypotheses with the largest log P beside the selection: one of each effect at its joint."""
    hypotheses, taken = equations.library.hypotheses, {equations.library.hypotheses[i].place for i in bare.arm_wide}
    free = [i for i in equations.library.reaching if hypotheses[i].place not in taken]
    scores = {i: total_score(equations, (*bare.arm_wide, i), bare) for i in free}
    best = {hypotheses[i].place: i for i in sorted(scores, key=lambda i: scores[i])}
    return sorted(best.values(), key=lambda i: -scores[i])[:TRIED]


def _improved(equations: NormalEquations, bare: Selection, arm_wide: tuple[int, ...]) -> Selection:
    """Arm-wide hypotheses fitted beside a selection without gains, and the selection of each joint improved beside."""
    start = refit_selection(equations, replace(bare, arm_wide=arm_wide))
    start = refit_selection(equations, start)  # joints weighted by what is left of each
    views = views_of(equations, start)
    local = tuple(improve(view, own) for view, own in zip(views, start.local, strict=True))
    return refit_selection(equations, replace(start, local=local))
