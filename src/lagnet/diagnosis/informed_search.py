"""The search for names, made again where the names found change what other effects see.

A gain, a delay or a limit acts on all the torque that passes the sensor, a payload's too, and friction that depends
on load rubs under it. Their columns follow from the nominal load at first. Where bodies that were found change the load
of a joint at which something is left, the search is made again with columns that follow from the load as then known.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lagnet.diagnosis.arm_search import Found, search_arm
from lagnet.diagnosis.fitting import Workbench, make_workbench
from lagnet.diagnosis.grams import collect_grams
from lagnet.diagnosis.library import Library, build_library
from lagnet.diagnosis.problem import Problem
from lagnet.diagnosis.prune import named_effects
from lagnet.diagnosis.second_look import look_again
from lagnet.diagnosis.shadows import drop_shadows
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected import NamedEffect, load_before
from lagnet.models.tilted_bodies import TILT

ROUNDS = 3  # a search with a load that is nearly right finds what is needed to make it right
CHANGED = 0.02  # of a joint's usual load: less does not change what is seen there
LEFT = 2.0  # times the noise power: a joint where less is left has nothing to look for


def search(problem: Problem, noise: np.ndarray) -> tuple[Problem, Workbench, Found]:
    """The best selection, its workbench, and the problem with what was known when its columns were made.

    Args:
        problem: just posed.
        noise: shape (dof,), noise floor [N m].
    """
    problem = replace(problem, known=mounting_of(problem))
    bench, found = _search_once(problem, noise)
    for _ in range(ROUNDS):
        known = _known(bench.library, found)
        if not _is_news(problem, known, found.fit.sse > LEFT * bench.samples * noise**2):
            break
        problem, last = replace(problem, known=known), (bench.library, found)
        bench, found = _search_once(problem, noise, last)
    return problem, bench, drop_shadows(bench, found)


def _search_once(
    problem: Problem, noise: np.ndarray, last: tuple[Library, Found] | None = None
) -> tuple[Workbench, Found]:
    bench, found = _search_among(problem, build_library(problem), noise, last)
    wider = look_again(problem, bench, found)
    return (bench, found) if wider is None else _search_among(problem, wider, noise, last)


def _search_among(
    problem: Problem, library: Library, noise: np.ndarray, last: tuple[Library, Found] | None
) -> tuple[Workbench, Found]:
    bench = make_workbench(library, collect_grams(problem, library, problem.fit))
    starts = (None,) if last is None or not last[1].far else (None, _carried_over(*last, library))
    return bench, search_arm(bench, bench.samples * noise**2, bench.samples * problem.scale**2, starts)


def _carried_over(library: Library, found: Found, to: Library) -> Found:
    """A selection in the indices of another library, less what that does not hold."""
    index = {(h.place, h.shape): i for i, h in enumerate(to.hypotheses)}

    def kept(chosen: tuple[int, ...]) -> tuple[int, ...]:
        places = ((h.place, h.shape) for h in (library.hypotheses[i] for i in chosen))
        return tuple(index[p] for p in places if p in index)

    return replace(found, far=kept(found.far), local=tuple(kept(own) for own in found.local))


def mounting_of(problem: Problem) -> tuple[NamedEffect, ...]:
    """A wall or ceiling that torque asks for: in whose field a payload must be seen from the start."""
    tilt = effect_named(TILT)
    if not hasattr(problem.nominal, "link_regressor"):
        return ()
    return tuple(NamedEffect(TILT, None, shape) for shape in tilt.shapes(problem.summary(), None) if shape)


def _known(library: Library, found: Found) -> tuple[NamedEffect, ...]:
    """Other bodies that were found: they reach joints where their torque is not told from a gain's by itself.

    What acts at one joint is left out: a column of its torque would say the same as the effect, in one parameter less.
    """
    effects = ((e, effect_named(e.effect)) for e in named_effects(library, found))
    return tuple(e for e, law in effects if law.stage == "body" and law.reaches_all and law.instantaneous)


def _is_news(problem: Problem, known: tuple[NamedEffect, ...], left: np.ndarray) -> bool:
    """Whether the load at some joint where something is left differs from the one that the columns followed from."""
    if not left.any() or not (known or problem.known):
        return False
    motion = problem.summary()
    before, now = (load_before(motion, effects, "signal") for effects in (problem.known, known))
    change = np.mean((now - before) ** 2, axis=0)
    return bool(np.any(left & (change > CHANGED**2 * np.mean(motion.load**2, axis=0))))
