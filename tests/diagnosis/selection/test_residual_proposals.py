"""The order of a ripple is in no list of hypotheses: it is found in what a first selection leaves."""

from __future__ import annotations

import numpy as np
from tests.diagnosis.posed import pose

from lagnet.diagnosis.selection.residual_proposals import proposals_from_residual

ORDER = 17.0
NEAR = 0.5  # of an order: the joint turns by 3 rad, over which the refit finds its way from there


def ripples(library, joint):
    return [dict(h.shape)["N"] for h in library.hypotheses if h.place == ("torque_ripple", joint)]


def test_the_order_of_a_ripple_beside_friction_is_proposed(plant, arm, at) -> None:
    real = plant(at(1, lambda q, v, a, t: 1.5 * np.sin(ORDER * q + 0.4) + 3.0 * v))
    posed = pose(arm, real.record(61), real.record(62))
    assert not ripples(posed.library, 1)
    wider = proposals_from_residual(posed.problem, posed.equations, posed.search())
    assert wider is not None
    assert min(abs(n - ORDER) for n in ripples(wider, 1)) < NEAR
    assert wider.hypotheses[: len(posed.library.hypotheses)] == posed.library.hypotheses


def test_nothing_is_proposed_where_nothing_is_left(plant, arm, at) -> None:
    real = plant(at(1, lambda q, v, a, t: 3.0 * v))
    posed = pose(arm, real.record(63), real.record(64))
    assert proposals_from_residual(posed.problem, posed.equations, posed.search()) is None
