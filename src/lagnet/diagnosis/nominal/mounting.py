"""g/|g| of the base: the direction of gravity that the torques show, where it is far from the model's."""

from __future__ import annotations

from lagnet.diagnosis.problem.problem import Problem
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.models.corrected.tilted_bodies import TILT
from lagnet.types import has_regressor


def mounting_of(problem: Problem) -> tuple[NamedEffect, ...]:
    """A wall or ceiling that the torque shows: a payload must be sought in that field of gravity from the start."""
    tilt = effect_named(TILT)
    if not has_regressor(problem.nominal):
        return ()
    return tuple(NamedEffect(TILT, None, shape) for shape in tilt.shapes(problem.summary(), None) if shape)
