"""An effect that all numbers of a link make needless goes, and the link takes them."""

from __future__ import annotations

from dataclasses import replace

from tests.diagnosis.rules.cases import JOINT, Bench, offset_beside_a_heavier_link, offset_of_a_shifted_centre

from lagnet.diagnosis.rules.apply import apply_rules
from lagnet.diagnosis.rules.freed_link import FreedLink


def test_the_link_is_freed_where_its_effect_goes(arm, plant, at) -> None:
    candidate = offset_of_a_shifted_centre(Bench(arm, plant, at, {}))
    left = apply_rules([FreedLink()], candidate)
    (link,) = (left.candidate.library.hypotheses[i] for i in left.candidate.indices)
    assert (link.effect, link.joint, link.shape) == ("link_inertia", JOINT, ())
    assert left.candidate.selection.fit.sse[JOINT] < candidate.selection.fit.sse[JOINT]


def test_an_effect_at_a_joint_behind_the_link_is_not_asked(arm, plant, at) -> None:
    candidate = offset_of_a_shifted_centre(Bench(arm, plant, at, {}), JOINT + 1)
    assert candidate.selection.local[JOINT + 1]
    assert FreedLink().rejected(candidate) == ()


def test_the_limit_of_a_tie_decides(arm, plant, at) -> None:
    candidate = offset_beside_a_heavier_link(Bench(arm, plant, at, {}))
    assert not FreedLink().rejected(candidate)
    strict = replace(candidate.problem, limits=replace(candidate.limits, tie_odds=99.5))
    assert FreedLink().rejected(replace(candidate, problem=strict))
