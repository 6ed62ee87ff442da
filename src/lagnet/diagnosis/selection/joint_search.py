"""argmax_S −(n / 2g) ln E(S) − Σ_k penalty_k: forward selection of one joint's hypotheses by cross-validation."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lagnet.diagnosis.selection.joint_view import JointView, compatible

ROUNDS = 40


def search_joint(view: JointView, warm: tuple[int, ...] = ()) -> tuple[int, ...]:
    """The best selection found from an empty start, a rich one and a given one."""
    starts = {(), rich_start(view), warm}
    found = [view.remembered(("improved", s), lambda s=s: improve(view, s)) for s in sorted(starts)]
    return max(found, key=lambda s: view.score(s))


def rich_start(view: JointView) -> tuple[int, ...]:
    """A start with every plain hypothesis that is feasible beside the others; superfluous ones are then dropped."""
    return view.remembered("rich", lambda: _rich_start(view))


def _rich_start(view: JointView) -> tuple[int, ...]:
    library = view.equations.library
    selection: tuple[int, ...] = ()
    plain = [i for i in library.local[view.joint] if not library.hypotheses[i].shape]
    errors = dict(zip(library.local[view.joint], view.system.with_each(())[0], strict=True))
    order = sorted(plain, key=lambda i: errors[i])
    for i in order:
        if compatible(view, selection, i) and np.isfinite(view.score((*selection, i))):
            selection = (*selection, i)
    return selection


def improve(view: JointView, start: tuple[int, ...]) -> tuple[int, ...]:
    """Adds, drops and exchanges hypotheses while log P grows."""
    selection, score = start, view.score(start)
    for _ in range(ROUNDS):
        for best_move in (best_plain_move, best_exchange):  # exchanges are many: only where nothing else helps
            best_score, best = best_move(view, selection)
            if best_score > score + 1e-9:
                selection, score = best, best_score
                break
        else:
            break
    return simplify(view, drop_immaterial(view, selection))


def simplify(view: JointView, selection: tuple[int, ...]) -> tuple[int, ...]:
    """Replaces a law by its special case wherever the law hardly lowers the squared error compared with it."""
    library = view.equations.library
    for i in selection:
        for name in library.hypotheses[i].law.contains:
            simple = [k for k in library.local[view.joint] if library.hypotheses[k].effect == name]
            if not simple or simple[0] in selection:
                continue
            other = tuple(simple[0] if k == i else k for k in selection)
            superfluous = not gains_over(view, selection, i, other) or _at_edge(view, i)
            if superfluous and np.isfinite(view.score(other)):
                return simplify(view, other)
    return selection


def gains_over(view: JointView, selection: Sequence[int], index: int, other: Sequence[int]) -> bool:
    """E(special case) − E(law) ≥ max(s E, c · explained): whether a law gains enough over its special case.

    At most the power of the joint's torque about its mean counts as explained: far from rest, a spring is a constant.
    """
    before, after = view.error(selection), view.error(other)
    explained = min(view.error([k for k in selection if k != index]) - before, view.torque_power)
    limits = view.limits
    return after - before >= max(limits.least_share * after, limits.least_over_special_case * explained)


def _at_edge(view: JointView, index: int) -> bool:
    """Whether a law stands at the least value of its shape that was tried: it may be no more than its special case.

    Additional friction close to standstill, for instance, cannot be distinguished there from a blurred sign of v.
    """
    library = view.equations.library
    own = library.hypotheses[index]
    tried = [library.hypotheses[k].shape for k in library.local[view.joint] if library.hypotheses[k].place == own.place]
    return len(tried) > 1 and own.shape == min(tried)


def drop_immaterial(view: JointView, selection: tuple[int, ...]) -> tuple[int, ...]:
    """Drops effects that are too small to be claimed, the smallest first."""
    while True:
        idle = [i for i in selection if not view.matters(selection, i)]
        if not idle:
            return selection
        losses = {i: view.error([k for k in selection if k != i]) for i in idle}
        worst = min(losses, key=lambda i: losses[i])
        selection = tuple(i for i in selection if i != worst)


Move = tuple[float, tuple[int, ...]]
"""A selection with its log P."""


def best_plain_move(view: JointView, selection: tuple[int, ...]) -> Move:
    """The best selection with one hypothesis dropped or added."""
    dropped = [(view.score(s), s) for s in without_each(selection)]
    return max([*dropped, best_addition(view, selection, selection)], key=lambda m: m[0])


def best_exchange(view: JointView, selection: tuple[int, ...]) -> Move:
    """The best selection with one hypothesis in the place of another."""
    found = [best_addition(view, base, selection) for base in without_each(selection)]
    return max(found, key=lambda m: m[0], default=(-np.inf, selection))


def without_each(selection: tuple[int, ...]) -> list[tuple[int, ...]]:
    """Selections with one hypothesis dropped."""
    return [tuple(k for k in selection if k != i) for i in selection]


def best_addition(view: JointView, base: tuple[int, ...], tried: tuple[int, ...]) -> Move:
    """The best selection with one hypothesis added that is none of those tried already."""
    local = view.equations.library.local[view.joint]
    if not local:
        return -np.inf, base
    scores = view.scores_with_each(base).copy()
    scores[[local.index(i) for i in tried]] = -np.inf
    best = int(np.argmax(scores))
    return float(scores[best]), (*base, local[best])
