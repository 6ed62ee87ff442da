"""What the consulted cases are counted by, on cases written by hand."""

from __future__ import annotations

import pytest
from validation.ablations.consulted import open_rules
from validation.ablations.consulted_summary import differences, is_hidden, summary

PLAIN = {"viscous_friction @ elbow": {"Fv": [1.0, 0.9, 1.1]}}
CASE = {
    "kind": "simulated",
    "name": "plant 3",
    "hidden": ["viscous_friction @ elbow", "unlisted:belt @ wrist"],
    "at_any_point": {"surrogate_terms: torque_gain @ 2": 3, "lack_of_fit: payload @ arm": 1},
    "in_the_verdict": ["lack_of_fit: payload @ arm"],
    "names": PLAIN,
    "nmse_named": [0.01, 0.02],
    "without": {
        "surrogate_terms": {
            "names": {**PLAIN, "torque_gain @ wrist | joint_spring": {"g": [1.1, 1.0, 1.2]}},
            "nmse_named": [0.01, 0.01],
        }
    },
}


def test_rejections_are_counted_by_cases() -> None:
    found = summary([CASE])
    assert found["surrogate_terms"]["simulated"] == {
        "cases": 1,
        "at_any_point": 1,
        "in_the_verdict": 0,
        "asked_without": 1,
        "other_names_without": 1,
    }
    assert found["lack_of_fit"]["simulated"]["in_the_verdict"] == 1
    assert found["value_at_bound"]["simulated"]["at_any_point"] == 0


def test_a_difference_tells_the_names_whether_they_are_hidden_and_the_errors() -> None:
    ((key, found),) = differences([CASE]).items()
    assert key == "surrogate_terms__simulated__plant_3"
    (name,) = found["named_without_it"]
    assert name["name"] == "torque_gain @ wrist | joint_spring"
    assert name["is_hidden"] is False
    assert found["named_with_it"] == []
    assert found["error_without_over_with"] == [1.0, 0.5]


@pytest.mark.parametrize(
    ("name", "hidden"),
    [
        ("viscous_friction @ elbow", True),
        ("quadratic_drag @ elbow | viscous_friction", True),
        ("viscous_friction @ wrist", False),
        ("payload @ None", False),
    ],
)
def test_a_name_is_hidden_where_it_or_a_tie_is_at_its_joint(name: str, hidden: bool) -> None:
    assert is_hidden(name, CASE["hidden"]) == hidden


def test_only_rules_that_rejected_and_are_not_known_yet_are_asked_further() -> None:
    assert open_rules(CASE, ["surrogate_terms", "lack_of_fit", "value_at_bound"]) == ["lack_of_fit"]
