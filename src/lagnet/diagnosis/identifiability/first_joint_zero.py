"""a · (g′ − g) = 0, a the axis of the first joint: gravity turned about it, as an error of the joint's zero turns it.

The first joint's angle says nothing of the arm behind it but where gravity points. An arm mounted with that axis level,
or on a wall, thus cannot tell its base tilted about it from an encoder that counts from elsewhere.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from lagnet.diagnosis.identifiability.rivals import Comparison
from lagnet.diagnosis.problem.problem import Problem
from lagnet.diagnosis.regression.library import Library
from lagnet.effects.catalogue import effect_named
from lagnet.effects.inertia.gravity_tilt import GravityTilt
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.rigid_body.robot import Robot

TILT, ZERO = "gravity_tilt", "encoder_offset"
ALONG = 0.02  # of g′ − g, that may point along the axis
UPRIGHT = 0.1  # sine of the axis' angle with gravity, below which turning about it turns no gravity


def tie_tilt_and_first_zero(
    problem: Problem, library: Library, comparisons: Sequence[Comparison], effects: Sequence[NamedEffect]
) -> tuple[Comparison, ...]:
    """The comparisons, a tilt that turns gravity about the first joint tied with an offset of its encoder.

    Args:
        problem: gives the nominal model.
        library: of the hypotheses.
        comparisons: one for each named effect.
        effects: the named effects, refitted.
    """
    tilt = next((e for e in effects if e.effect == TILT), None)
    if tilt is None or not _is_about_first_joint(problem, tilt):
        return tuple(comparisons)
    return tuple(
        replace(c, tied=tuple(sorted({*c.tied, ZERO}))) if library.hypotheses[c.index].effect == TILT else c
        for c in comparisons
    )


def _is_about_first_joint(problem: Problem, tilt: NamedEffect) -> bool:
    """Whether a turn of the first joint turns gravity likewise."""
    arm, law = problem.nominal, effect_named(TILT)
    if not isinstance(arm, Robot) or not isinstance(law, GravityTilt) or arm.joint_types[0] == "prismatic":
        return False
    gravity, axis = np.asarray(arm.gravity, dtype=float), arm.joint_axes(np.zeros(arm.n_dof))[0]
    change = law.gravity_of(gravity, tilt.values) - gravity
    turns = np.linalg.norm(np.cross(axis, gravity)) > UPRIGHT * np.linalg.norm(gravity)
    return bool(turns and abs(axis @ change) <= ALONG * np.linalg.norm(change))
