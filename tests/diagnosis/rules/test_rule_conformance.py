"""What holds of every rule of elimination: it rejects one case and not another, and says what it rejects and why."""

from __future__ import annotations

import re
from dataclasses import FrozenInstanceError, fields, is_dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from tests.diagnosis.rules.cases import CASES, Bench

from lagnet.diagnosis.rules.apply import apply_rules
from lagnet.diagnosis.rules.catalogue import RULES
from lagnet.diagnosis.rules.rule import RejectionRule

REFERENCES = Path(__file__).resolve().parents[3] / "docs" / "references.md"
EACH = pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)


@pytest.fixture(scope="session")
def bench(arm, plant, at) -> Bench:
    """Arm and plants, with the problems that were already posed."""
    return Bench(arm, plant, at, {})


def test_every_rule_has_its_cases_and_a_name_of_its_own() -> None:
    assert [r.name for r in RULES] == list(dict.fromkeys(r.name for r in RULES))
    assert {r.name for r in RULES} == set(CASES)


SHARED = ("canonical_form", "not_significant")  # whose limits are those of DecisionLimits, or a 95 % interval


@EACH
def test_a_rule_says_what_must_hold_and_shows_its_limits(rule: RejectionRule) -> None:
    assert re.fullmatch(r"[a-z]+(_[a-z]+)*", rule.name)
    assert rule.statement
    assert rule.statement[0].islower()
    assert not rule.statement.endswith(".")
    assert is_dataclass(rule)
    shared = "shared" in (type(rule).__doc__ or "") or rule.name in SHARED
    assert fields(rule) or shared, "the limits of a rule are its fields, or those that steps share"
    assert all(f"{f.name}:" in (type(rule).__doc__ or "") for f in fields(rule))
    assert type(rule)() == rule, "every limit has a default"
    with pytest.raises(FrozenInstanceError):
        setattr(rule, fields(rule)[0].name if fields(rule) else "name", 0.0)


@EACH
def test_the_source_of_a_rule_stands_among_the_references(rule: RejectionRule) -> None:
    assert not rule.source or f'id="{rule.source}"' in REFERENCES.read_text()


@EACH
def test_it_rejects_what_it_must_and_says_why(rule: RejectionRule, bench: Bench) -> None:
    case, effect, _ = CASES[rule.name]
    candidate = case(bench)
    rejected = rule.rejected(candidate)
    assert effect in {r.effect for r in rejected}
    for one in rejected:
        hypothesis = candidate.library.hypotheses[one.index]
        assert one.index in candidate.indices
        assert (one.effect, one.joint, one.rule) == (*hypothesis.place, rule.name)
        assert np.isfinite(one.value)
        assert np.isfinite(one.limit)
        assert one.detail
        assert not one.detail.endswith(".")
    assert [r.index for r in rule.rejected(candidate)] == [r.index for r in rejected], "a rule remembers nothing"


@EACH
def test_it_leaves_alone_what_it_must(rule: RejectionRule, bench: Bench) -> None:
    assert rule.rejected(CASES[rule.name][2](bench)) == ()


@EACH
def test_what_it_rejects_is_gone_after_elimination(rule: RejectionRule, bench: Bench) -> None:
    case, effect, _ = CASES[rule.name]
    candidate = case(bench)
    left = apply_rules([rule], candidate)
    named = [left.candidate.library.hypotheses[i].effect for i in left.candidate.indices]
    assert effect in {r.effect for r in left.rejected}
    assert effect not in named
    assert rule.rejected(left.candidate) == ()


@EACH
def test_nothing_selected_is_nothing_rejected(rule: RejectionRule, bench: Bench) -> None:
    candidate = bench.candidate("perfect", bench.plant().record, [])
    assert rule.rejected(candidate) == ()


def test_a_limit_that_is_passed_decides(bench: Bench) -> None:
    (rule,) = (r for r in RULES if r.name == "no_holdout_gain")
    candidate = CASES[rule.name][2](bench)
    assert rule.rejected(candidate) == ()
    strict = replace(candidate.problem, limits=replace(candidate.limits, least_ratio=1e9))
    assert rule.rejected(replace(candidate, problem=strict))
