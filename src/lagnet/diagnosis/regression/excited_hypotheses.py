"""The hypotheses that recordings can show: each effect of the catalogue where the recorded motion excites it."""

from __future__ import annotations

import numpy as np

from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.regression.library import Abstention, Hypothesis, Library, as_seen
from lagnet.effects.catalogue import CATALOGUE
from lagnet.effects.effect import Effect
from lagnet.effects.motion import Motion
from lagnet.models.corrected.modelled import modelled_weight


def build_library(problem: Problem, effects: tuple[Effect, ...] | None = None) -> Library:
    """Every effect of the catalogue at every joint, except those that the recorded motion does not excite."""
    summary = problem.summary()
    probe = _head(summary)
    has_bodies = hasattr(problem.nominal, "link_regressor")
    hypotheses: list[Hypothesis] = []
    widths: list[int] = []
    abstentions: list[Abstention] = []
    for effect in effects or tuple(e for e in CATALOGUE.values() if not e.is_transient):
        if effect.is_body and problem.given is not None:  # the links are free already
            continue
        for joint in _places(effect, problem.n_dof):
            seen = as_seen(summary, problem.known_to(effect), effect)
            reason = _reason_against(effect, seen, joint, has_bodies)
            shapes = () if reason else effect.shapes(seen, joint)
            if reason:
                abstentions.append(Abstention(effect.name, joint, reason))
            for shape in shapes:
                modelled = modelled_weight(problem.nominal, effect.name, joint)
                hypotheses.append(Hypothesis(effect.name, joint, tuple(sorted(shape.items())), modelled))
                widths.append(effect.columns(probe, joint, shape).shape[-1])
    return Library(tuple(hypotheses), tuple(widths), problem.n_dof, tuple(abstentions))


def _places(effect: Effect, n_dof: int) -> list[int | None]:
    return [j for j in ((None,) if effect.whole_arm else range(n_dof)) if effect.exists_at(j)]


def _reason_against(effect: Effect, motion: Motion, joint: int | None, has_bodies: bool) -> str | None:
    if effect.needs_bodies and not has_bodies:
        return "the nominal model has no kinematics from which a body's torque could be computed"
    return effect.excitation(motion, joint)


def _head(motion: Motion, n: int = 40) -> Motion:
    rows = slice(0, n)
    time = np.arange(motion.time[rows].size, dtype=float) * 0.01
    q, v, a, load = (x[rows] for x in (motion.q, motion.v, motion.a, motion.load))
    return Motion(time, q, v, a, load, motion.slow, motion.model, straight=motion.straight)
