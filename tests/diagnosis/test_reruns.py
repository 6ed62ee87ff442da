"""Names are asked for anew beside all links where these leave a third of what names leave, and not for a rhythm."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.identified.fit import identify
from lagnet.diagnosis.reruns import MUCH, is_outdone, leaves_much
from lagnet.diagnosis.unexplained.remainder import remainder_of, remainder_sizes


def friction(q, v, a, body):
    return 0.5 * np.sign(v)


def swaying(q, v, a, body):
    """A torque of its own rhythm, which no function of motion predicts."""
    return 0.5 * np.sign(v) + 0.3 * np.sin(7.0 * np.arange(len(v)) / 100.0)[:, None]


@pytest.mark.parametrize(("factor", "law", "outdone"), [(1.3, friction, True), (1.0, swaying, False)])
def test_links_that_differ_outdo_names_and_a_rhythm_does_not(plant, arm, factor, law, outdone) -> None:
    links = arm.inertial_parameters() * np.array([1.0, factor, 1.0])[:, None]
    real = plant(law, robot=arm.with_inertial_parameters(links))
    posed = pose(arm, real.record(1), real.record(2))
    candidate = posed.candidate(posed.select({j: ["coulomb_friction"] for j in range(3)}))
    after = remainder_of(posed.problem, candidate.effects)
    state: Any = SimpleNamespace(problem=posed.problem, sizes=remainder_sizes(posed.problem, after, posed.noise))
    assert leaves_much(state)
    assert max(s.share for s in state.sizes) > MUCH
    assert is_outdone(state, identify(posed.problem, ())) is outdone
    assert not is_outdone(state, None)


def test_what_names_explain_asks_for_no_links(plant, arm) -> None:
    real = plant(friction)
    posed = pose(arm, real.record(1), real.record(2))
    candidate = posed.candidate(posed.select({j: ["coulomb_friction"] for j in range(3)}))
    after = remainder_of(posed.problem, candidate.effects)
    state: Any = SimpleNamespace(problem=posed.problem, sizes=remainder_sizes(posed.problem, after, posed.noise))
    assert not leaves_much(state)
