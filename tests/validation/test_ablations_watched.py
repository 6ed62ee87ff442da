"""What an ablation study leaves out because it cannot matter, and what it halves and doubles."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from validation.ablations.content import Contents
from validation.ablations.limit_table import LIMITS_OF_RULES, RATIOS, SHARED_LIMITS, changed_value
from validation.ablations.table import ABLATIONS, NOTHING, WITHOUT_RULE
from validation.ablations.watched import Effects, watched_rules

from lagnet.diagnosis.rules.catalogue import RULES
from lagnet.diagnosis.rules.rule import Rejection, RejectionRule
from lagnet.diagnosis.settings import DecisionLimits


class Fixed(RejectionRule):
    """A rule that always rejects the same."""

    name, statement, source = "fixed", "none", ""

    def __init__(self, found: tuple[Rejection, ...]) -> None:
        self.found = found

    def rejected(self, candidate: Any) -> tuple[Rejection, ...]:
        """What it was made with."""
        return self.found


REJECTION = Rejection(3, "coulomb_friction", 1, "fixed", 0.0, 1.0, "")
NO_CANDIDATE: Any = None  # the rules here look at none


@pytest.mark.parametrize("found", [(), (REJECTION,)])
def test_a_rule_is_noted_where_it_rejects(found: tuple[Rejection, ...]) -> None:
    seen = Effects()
    (rule,) = watched_rules([Fixed(found)], [], seen)
    assert rule.rejected(NO_CANDIDATE) == found
    assert seen.rules == ({"fixed"} if found else set())
    without = replace(NOTHING, name="without fixed", less=frozenset({"fixed"}))
    assert seen.of(without) == bool(found)
    assert Effects.from_json(seen.to_json()) == seen


def test_a_changed_limit_is_noted_where_it_decides_otherwise() -> None:
    seen = Effects()
    other = replace(NOTHING, name="fixed.limit at half", changed=(Fixed(()),))
    same = replace(NOTHING, name="fixed.limit at twice", changed=(Fixed((REJECTION,)),))
    (rule,) = watched_rules([Fixed((REJECTION,))], [other, same], seen)
    rule.rejected(NO_CANDIDATE)
    assert seen.of(other)
    assert not seen.of(same)


def test_shared_limits_are_always_asked() -> None:
    assert all(Effects().of(a) for a in SHARED_LIMITS)
    assert not any(Effects().of(a) for a in ABLATIONS if a.less and not a.instead)


def test_questions_are_known_by_their_content() -> None:
    contents = Contents()
    one, same, other = (np.arange(4.0), [1, "a"]), (np.arange(4.0), [1, "a"]), (np.arange(4.0), [1, "b"])
    assert contents.digest(one) == contents.digest(same) != contents.digest(other)
    assert contents.digest(DecisionLimits()) == contents.digest(DecisionLimits())
    assert contents.digest(object()) != contents.digest(object())


def test_every_limit_is_halved_and_doubled() -> None:
    names = {a.name.rpartition(" at ")[0] for a in (*SHARED_LIMITS, *LIMITS_OF_RULES)}
    assert names >= RATIOS
    assert len(SHARED_LIMITS) + len(LIMITS_OF_RULES) == 2 * len(names)
    assert len(WITHOUT_RULE) == len(RULES)
    assert changed_value("tie_odds", 1.3, 0.5) == 0.65
    assert changed_value("above_noise", 1.25, 2.0) == 1.5
    assert changed_value("most_names", 4, 0.5) == 2
