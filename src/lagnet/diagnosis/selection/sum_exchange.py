"""A sum of laws taken apart, where a wider law takes the place of one of its terms.

Unequal dry friction is Coulomb friction and an offset. Stribeck friction beside that offset is two exchanges away, and
drag in the place of viscous friction the best that single ones reach.
"""

from __future__ import annotations

from dataclasses import replace

from lagnet.diagnosis.regression.cross_validation import NormalEquations
from lagnet.diagnosis.selection.arm_search import Selection, refit_selection, views_of
from lagnet.diagnosis.selection.joint_search import improve
from lagnet.diagnosis.selection.joint_view import JointView, compatible


def exchange_sums(equations: NormalEquations, found: Selection) -> Selection:
    """The selection with sums of each joint in parts where log P is greater with them, arm-wide hypotheses as they are.

    Only after the bodies: before, what they leave at a joint looks like a wider law of the joint, and hides them.
    """
    views = views_of(equations, found)
    local = tuple(_exchanged(view, own) for view, own in zip(views, found.local, strict=True))
    if local == found.local:
        return found
    apart = refit_selection(equations, replace(found, local=local))
    return apart if apart.score > found.score else found


def _exchanged(view: JointView, own: tuple[int, ...]) -> tuple[int, ...]:
    parts = max(in_parts(view, own), key=view.score, default=own)
    if view.score(parts) <= view.score(own):
        return own
    return max(own, improve(view, parts), key=view.score)


def in_parts(view: JointView, selection: tuple[int, ...]) -> list[tuple[int, ...]]:
    """Selections with the terms of a sum in its place, one of them as a wider law that may not stand beside the sum.

    Unequal dry friction is Coulomb friction and an offset; Stribeck friction beside that offset is two exchanges away.
    """
    return [s for i in selection for s in _parts_of(view, i, tuple(k for k in selection if k != i))]


def _parts_of(view: JointView, whole: int, rest: tuple[int, ...]) -> list[tuple[int, ...]]:
    library = view.equations.library
    terms, out = library.terms_of(whole), []
    for k in library.local[view.joint]:
        law = library.hypotheses[k].law
        others = tuple(i for name, i in terms.items() if name not in law.contains)
        wider = len(others) < len(terms) and not law.sum_of and not compatible(view, (whole,), k)
        if wider and compatible(view, (*rest, *others), k) and all(compatible(view, rest, i) for i in others):
            out.append(tuple(sorted((*rest, *others, k))))
    return out
