"""The share of dry friction that joints keep at rest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lagnet.diagnosis.estimation.friction_at_rest import friction_at_rest
from lagnet.diagnosis.problem.problem import Problem, Segment
from lagnet.models.corrected.named_effects import NamedEffect

DRY, SHARE, RATE = 3.0, 0.6, 100.0
COULOMB = (NamedEffect("coulomb_friction", 0, {"Fc": DRY}),)


def stop_and_go() -> Problem:
    """One joint that moves for two seconds and rests for two, in turns, and keeps a share of its friction there."""
    time = np.arange(int(40 * RATE)) / RATE
    v = np.where(time % 4.0 < 2.0, np.sin(np.pi * (time % 4.0) / 2.0), 0.0) * np.where(time % 8.0 < 4.0, 1.0, -1.0)
    last = np.where(time % 8.0 < 4.0, 1.0, -1.0)
    torque = DRY * np.where(v == 0.0, SHARE * last, np.sign(v))
    none = np.zeros((time.size, 1))
    keep = np.arange(50, time.size - 50, 5)
    piece = Segment(time, none, v[:, None], none, torque[:, None], none, 0, keep, v[keep, None] != 0.0)
    return Problem(None, (piece,), (piece,), RATE, 10.0, np.array([0.01]), ("joint",))


@pytest.mark.parametrize("known", [None, np.array([0.3]), np.array([1.0])])
def test_the_share_is_found_whatever_was_taken_for_it_before(known) -> None:
    np.testing.assert_allclose(friction_at_rest(replace(stop_and_go(), held=known), COULOMB), SHARE, atol=0.05)


def test_nothing_is_said_to_stay_where_no_friction_has_a_name() -> None:
    np.testing.assert_array_equal(friction_at_rest(stop_and_go(), ()), 0.0)
