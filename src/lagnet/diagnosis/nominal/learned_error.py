"""Names that may be the error of a nominal model which was learned: such an error looks like an encoder or a spring."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.models.corrected.named_effects import NamedEffect, torque_with

LAGRANGIANS = ("delan", "delan-blackbox")  # networks whose torque is the same forwards and backwards in time
NETWORKS = (*LAGRANGIANS, "ffnn", "delan-ffnn")
ONE_WAY = 0.5  # of an effect's power that changes its sign with time: more is not the error of a Lagrangian

Name = tuple[str, int | None]
"""An effect and its joint, None for the whole arm."""


def was_learned(nominal: Any) -> bool:
    """Whether a model is a network, or one that was corrected."""
    return _kind(nominal) in NETWORKS


def _kind(nominal: Any) -> str | None:
    return getattr(getattr(nominal, "nominal", nominal), "model_kind", None)


def may_be_its_error(problem: Problem, effects: tuple[NamedEffect, ...]) -> frozenset[Name]:
    """The effects whose torque a learned nominal model may simply have missed; none where bodies are given.

    A network is wrong where its training did not lead, by as much as it likes and smoothly in q, v and a. The torque of
    a Lagrangian does not change when a motion is run backwards, and so neither does its error: friction and
    delays do.
    """
    if not was_learned(problem.nominal):
        return frozenset()
    lagrangian = _kind(problem.nominal) in LAGRANGIANS
    doubtful = (e for e in effects if not (lagrangian and _one_way(problem, e) > ONE_WAY))
    return frozenset((e.effect, e.joint) for e in doubtful)


def _one_way(problem: Problem, effect: NamedEffect) -> float:
    """Share of the power of an effect's held-out torque that changes its sign when the motion is run backwards."""
    odd = even = 0.0
    for piece in problem.holdout:
        there, back = _added(problem, piece, effect), _added(problem, _backwards(piece), effect)[::-1]
        odd += float(np.sum((there - back) ** 2))
        even += float(np.sum((there + back) ** 2))
    return odd / max(odd + even, 1e-300)


def _added(problem: Problem, piece: Segment, effect: NamedEffect) -> np.ndarray:
    motion = piece.motion(problem)
    return torque_with(motion, (effect,)) - motion.load


def _backwards(piece: Segment) -> Segment:
    turned = {name: getattr(piece, name)[::-1] for name in ("q", "a", "tau", "load")}
    return replace(piece, v=-piece.v[::-1], **turned)
