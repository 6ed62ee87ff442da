"""The grading of the study of parameter sets: a wrong set is called wrong, an open joint is not, lines are missed."""

from __future__ import annotations

import json

import pytest
from validation.compare.simulated import Graded, grade, torque_case
from validation.compare.study import HERE, judge, summary


@pytest.mark.parametrize(
    ("said", "right", "ratio", "expected"), [(0, 0, 3.0, "right"), (1, 0, 3.0, "wrong"), (1, 0, 1.05, "right")]
)
def test_the_other_set_is_wrong_unless_both_are_as_good(said: int, right: int, ratio: float, expected: str) -> None:
    assert grade(said, right, ratio) == expected


def test_lines_are_missed_by_wrong_open_and_too_narrow() -> None:
    good = Graded([3.0], ["right"], ["wrong"], [True], [True])
    bad = Graded([3.0, 2.0], ["wrong", "undecided"], ["right", "right"], [False], [False])
    found = {"torque": summary([good]), "motion": summary([bad]), "real": [{"contradicted": 1}]}
    passed = [ok for *_, ok in judge(found)]
    assert passed == [True, True, True, False, False, False, False]


def test_a_simulated_arm_is_graded_by_its_own_truth() -> None:
    graded = torque_case(300)
    assert len(graded.ratio) == 3
    assert "wrong" not in graded.said
    assert sum(graded.covered) >= 0.8 * len(graded.covered) > 0


def test_the_kept_result_is_judged_by_the_lines_of_today() -> None:
    kept = json.loads((HERE / "result.json").read_text(encoding="utf-8"))
    assert [line["passed"] for line in kept["lines"]] == [ok for *_, ok in judge(kept)]
