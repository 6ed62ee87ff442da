"""Beside a large cause a small effect is claimed where it explains more than all that is left, and not else."""

from __future__ import annotations

import numpy as np
from tests.diagnosis.posed import pose

from lagnet.diagnosis.rules.negligible_torque import NegligibleTorque

JOINT = 1
LARGE, SMALL = 30.0, 0.25  # [N m s/rad], [N m]: a sixtieth of the torque
BOTH = ("viscous_friction", "coulomb_friction")


def rejected(arm, real) -> set[str]:
    """What of both effects is too small, where exactly these are fitted."""
    posed = pose(arm, real.record(1), real.record(2))
    candidate = posed.candidate(posed.select({JOINT: BOTH}))
    sizes = NegligibleTorque.sizes(candidate.problem, candidate.effects)
    assert dict(zip((e.effect for e in candidate.effects), np.array(sizes) > 1.0, strict=True)) == {
        "viscous_friction": True,
        "coulomb_friction": False,
    }  # against the mismatch alone
    return {r.effect for r in NegligibleTorque().rejected(candidate)}


def law(v):
    return LARGE * v + SMALL * np.tanh(v / 1e-3)


def test_it_stays_where_it_explains_more_than_what_is_left(plant, arm, at) -> None:
    assert rejected(arm, plant(at(JOINT, lambda q, v, a, t: law(v)))) == set()


def test_it_goes_where_more_is_left(plant, arm, at) -> None:
    real = plant(at(JOINT, lambda q, v, a, t: law(v) + 4.0 * SMALL * np.sin(11.0 * q)))
    assert rejected(arm, real) == {"coulomb_friction"}
