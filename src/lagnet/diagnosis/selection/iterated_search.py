"""Selection repeated with columns X_k(τ_nominal + Σ τ_body), where bodies that were found change the joint torque.

A gain, a delay or a limit acts on the whole torque at the sensor, a payload's included, and so does load-dependent
friction. Their columns follow from the nominal torque at first. Where bodies that were found change the torque of a
joint that has a residual above noise, the selection is repeated with columns that follow from the changed torque.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lagnet.diagnosis.nominal.mounting import mounting_of
from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.regression.block_gram import collect_block_grams
from lagnet.diagnosis.regression.cross_validation import NormalEquations, sum_normal_equations
from lagnet.diagnosis.regression.excited_hypotheses import build_library
from lagnet.diagnosis.regression.library import Library
from lagnet.diagnosis.selection.arm_search import Selection, score_under, search_arm
from lagnet.diagnosis.selection.below_limits import found_below_limits
from lagnet.diagnosis.selection.form_exchange import exchange_forms
from lagnet.diagnosis.selection.gain_exchange import exchange_gains
from lagnet.diagnosis.selection.link_exchange import exchange_links
from lagnet.diagnosis.selection.named_effects import named_effects
from lagnet.diagnosis.selection.residual_proposals import proposals_from_residual
from lagnet.diagnosis.selection.sum_exchange import exchange_sums
from lagnet.effects.catalogue import effect_named
from lagnet.effects.inertia.gravity_tilt import is_bent
from lagnet.models.corrected.named_effects import NamedEffect, load_before
from lagnet.models.corrected.tilted_bodies import TILT

ROUNDS = 3  # at most; each starts from the torque that the one before found
CHANGED = 0.02  # of a joint's rms torque: a smaller change does not alter the columns
LEFT = 2.0  # times the noise power: a joint with a smaller residual needs no further effect


def search(problem: Problem, noise: np.ndarray) -> tuple[Problem, NormalEquations, Selection]:
    """The best selection, its normal equations, and the problem with the bodies that its columns follow from.

    Rounds need not settle where something is of no law's form: the best of them counts, the later of equals. One whose
    columns follow from bodies that it does not select itself does not count: no penalty was paid for these.

    Args:
        problem: just posed.
        noise: shape (dof,), noise floor [N m].
    """
    problem = replace(problem, known=mounting_of(problem), below_limits=())
    rounds = [(problem, *_search_once(problem, noise))]
    for _ in range(ROUNDS):
        problem, equations, found = rounds[-1]
        known, left = _known(equations.library, found), found.fit.sse > LEFT * equations.samples * noise**2
        below = found_below_limits(problem, equations.library, found, known, left * found.fit.sse / equations.samples)
        if not _is_news(problem, known, below, left):
            break
        problem = replace(problem, known=known, below_limits=below)
        rounds.append((problem, *_search_once(problem, noise, (equations.library, found))))
    counted = [*rounds[:1], *(r for r in rounds[1:] if _bears_its_columns(r[0], _known(r[1].library, r[2])))]
    if any(r[0].below_limits for r in counted):  # a limit that was missed correlates the residual, and g differs widely
        memory = np.max([found.scales.inefficiency for _, _, found in counted], axis=0)
        return max(reversed(counted), key=lambda r: score_under(r[1], r[2], memory))
    return max(reversed(counted), key=lambda r: r[2].score)


def _search_once(
    problem: Problem, noise: np.ndarray, last: tuple[Library, Selection] | None = None
) -> tuple[NormalEquations, Selection]:
    equations, found = _search_among(problem, build_library(problem), noise, last)
    wider = proposals_from_residual(problem, equations, found)
    if wider is not None:
        equations, found = _search_among(problem, wider, noise, last)
    return exchange_links(problem, *exchange_forms(problem, equations, found))


def _search_among(
    problem: Problem, library: Library, noise: np.ndarray, last: tuple[Library, Selection] | None
) -> tuple[NormalEquations, Selection]:
    equations = sum_normal_equations(library, collect_block_grams(problem, library, problem.fit), problem.limits)
    starts = (None,) if last is None or not last[1].arm_wide else (None, _carried_over(*last, library))
    found = search_arm(equations, equations.samples * noise**2, equations.samples * problem.scale**2, starts)
    return equations, exchange_gains(equations, exchange_sums(equations, found))


def _carried_over(library: Library, found: Selection, to: Library) -> Selection:
    """A selection in the indices of another library, without hypotheses that it lacks; links in their free form."""
    index = {(h.place, h.shape): i for i, h in enumerate(to.hypotheses)}

    def kept(chosen: tuple[int, ...]) -> tuple[int, ...]:
        places = ((h.place, () if h.law.changes_link else h.shape) for h in (library.hypotheses[i] for i in chosen))
        return tuple(index[p] for p in places if p in index)

    return replace(found, arm_wide=kept(found.arm_wide), local=tuple(kept(own) for own in found.local))


def _known(library: Library, found: Selection) -> tuple[NamedEffect, ...]:
    """Arm-wide bodies that were found: they also load joints where their torque alone does not differ from a gain's.

    Effects of one joint are omitted: a column of their torque would be the effect itself, with one parameter less.
    """
    effects = ((e, effect_named(e.effect)) for e in named_effects(library, found))
    return tuple(e for e, law in effects if law.stage == "body" and law.reaches_all and law.instantaneous)


def _bears_its_columns(problem: Problem, selected: tuple[NamedEffect, ...]) -> bool:
    """Whether Σ_j ‖τ_selected − τ_known‖² / ‖τ‖² < Σ_j ‖τ_nominal − τ_known‖² / ‖τ‖², or no body was known."""
    if not problem.known:
        return True
    motion = problem.summary()
    known, now = (load_before(motion, effects, "signal") for effects in (problem.known, selected))
    scale = np.maximum(np.mean(motion.load**2, axis=0), 1e-300)
    apart, whole = (np.sum(np.mean((other - known) ** 2, axis=0) / scale) for other in (now, motion.load))
    return bool(apart < whole)


def _is_news(
    problem: Problem, known: tuple[NamedEffect, ...], below: tuple[NamedEffect, ...], left: np.ndarray
) -> bool:
    """Whether the torque of some joint with a residual above noise differs from that which the columns follow from.

    With a tilt too large for the law made linear about the level base, any joint counts: bodies may hide what was left.
    """
    if any(e.effect == TILT and is_bent(e.values) for e in known):
        left = np.ones_like(left)
    pair = (*problem.known, *problem.below_limits), (*known, *below)
    if not left.any() or not any(pair):
        return False
    motion = problem.summary()
    before, now = (load_before(motion, effects, "signal") for effects in pair)
    change = np.mean((now - before) ** 2, axis=0)
    return bool(np.any(left & (change > CHANGED**2 * np.mean(motion.load**2, axis=0))))
