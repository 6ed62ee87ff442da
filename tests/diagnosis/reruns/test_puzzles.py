"""Names are asked for anew beside all links where these leave a third of what names leave, and not for a rhythm."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.free_bodies import explains
from lagnet.diagnosis.identified.fit import identify
from lagnet.diagnosis.reruns.puzzles import MUCH, PUZZLING, is_identified, is_outdone, is_puzzled
from lagnet.diagnosis.settings import DecisionLimits
from lagnet.diagnosis.unexplained.remainder import remainder_of, remainder_sizes
from lagnet.models.corrected.named_effects import NamedEffect


def friction(q, v, a, body):
    return 0.5 * np.sign(v)


def swaying(q, v, a, body):
    """A torque of its own rhythm, which no function of motion predicts."""
    return 0.5 * np.sign(v) + 0.3 * np.sin(7.0 * np.arange(len(v)) / 100.0)[:, None]


def as_state(posed, effects) -> Any:
    """What is asked of a state, with these effects named."""
    after = remainder_of(posed.problem, effects)
    sizes = remainder_sizes(posed.problem, after, posed.noise)
    found = identify(posed.problem, effects)
    alone = identify(posed.problem, ())
    return SimpleNamespace(
        problem=posed.problem,
        effects=effects,
        sizes=sizes,
        sizes_beside_supposed=sizes,
        noise=posed.noise,
        identified=found,
        identified_alone=alone,
    )


@pytest.mark.parametrize(("factor", "law", "outdone"), [(1.3, friction, True), (1.0, swaying, False)])
def test_links_that_differ_outdo_names_and_a_rhythm_does_not(plant, arm, factor, law, outdone) -> None:
    links = arm.inertial_parameters() * np.array([1.0, factor, 1.0])[:, None]
    real = plant(law, robot=arm.with_inertial_parameters(links))
    posed = pose(arm, real.record(1), real.record(2))
    candidate = posed.candidate(posed.select({j: ["coulomb_friction"] for j in range(3)}))
    state = as_state(posed, candidate.effects)
    assert max(s.share for s in state.sizes) > MUCH
    assert is_outdone(state) is outdone
    load = NamedEffect(
        "payload", None, dict.fromkeys(("m", "cx", "cy", "cz", "Ixx", "Ixy", "Iyy", "Ixz", "Iyz", "Izz"), 0.0)
    )
    assert not is_outdone(as_state(posed, (*candidate.effects, load)))


def test_what_names_explain_asks_for_no_links(plant, arm) -> None:
    real = plant(friction)
    posed = pose(arm, real.record(1), real.record(2))
    candidate = posed.candidate(posed.select({j: ["coulomb_friction"] for j in range(3)}))
    assert not is_outdone(as_state(posed, candidate.effects))


def test_a_cause_that_could_have_several_names_is_no_puzzle(plant, arm) -> None:
    """Names of other joints stand as they are: links are not asked to explain what only lacks a name of its own."""
    real = plant(friction)
    nameless = DecisionLimits(most_names=0)
    state = diagnose([real.record(1), real.record(2)], arm, [real.record(3)], limits=nameless).state
    assert {(c.effect, c.joint) for c in state.ambiguous} == {("coulomb_friction", j) for j in range(3)}
    assert not state.effects
    assert min(size.share for size in state.sizes) > PUZZLING
    assert max(size.share for size in state.sizes_beside_supposed) < PUZZLING
    assert not is_puzzled(state)
    assert state.judged is None


@pytest.mark.parametrize("delta", [0.0, 0.4])
def test_links_explain_recordings_whatever_was_named_before(plant, arm, delta: float) -> None:
    """Beside an encoder offset that is not there the layer leaves much; in its place it leaves the noise."""
    links = arm.inertial_parameters() * np.array([1.5, 0.7, 1.4])[:, None]
    posed = pose(arm, *(plant(robot=arm.with_inertial_parameters(links)).record(seed) for seed in (1, 2)))
    state = as_state(posed, (NamedEffect("encoder_offset", 1, {"delta": delta}),))
    beside = explains(posed.problem, posed.problem.holdout, state.effects, state.identified.layer, posed.noise)
    assert beside == (delta == 0.0)
    assert is_identified(state)


@pytest.mark.slow
def test_a_load_keeps_its_name_beside_friction_that_no_law_has(plant, arm) -> None:
    loaded = arm.with_payload(1.5, np.array([0.05, 0.08, 0.15]), 0.006 * np.eye(3))
    size = plant().usual_torque()
    real = plant(lambda q, v, a, body: 0.4 * size * np.tanh(v / 0.5) * (1.0 + np.cos(3.0 * q)), robot=loaded)
    result = diagnose([real.record(1), real.record(2)], arm, [real.record(3)])
    assert any(u.share_of_mismatch > MUCH for u in result.verdict.unexplained)
    assert next(e for e in result.effects if e.effect == "payload").value("m") == pytest.approx(1.5, rel=0.2)
