"""Masses that nobody knew."""

from __future__ import annotations

import pytest

from lagnet.rigid_body.placeholders import are_placeholders
from lagnet.rigid_body.robot import load_description
from lagnet.types import has_mass, knows_masses

MASSES = {
    "none": ([0.0, 0.0, 0.0], True),
    "one for all": ([1.0] * 6, True),
    "one for all but a tool": ([1.0] * 5 + [2.5], True),
    "one for all but the base's link": ([4.0] + [0.2] * 5, True),
    "two twins of six": ([7.1, 12.7, 4.27, 2.0, 2.0, 0.365], False),
    "two alike": ([1.0, 1.0], False),
    "one link": ([95.0], False),
    "different": ([3.0, 2.0, 1.0], False),
}


@pytest.mark.parametrize("case", MASSES)
def test_links_of_one_mass_or_none_are_placeholders(case) -> None:
    masses, expected = MASSES[case]
    assert are_placeholders(masses) is expected


@pytest.mark.parametrize("name", ["ur5", "panda", "kinova"])
def test_makers_know_their_masses(name) -> None:
    robot = load_description(name)
    assert knows_masses(robot)
    assert has_mass(robot)


def test_a_model_that_does_not_say_is_taken_to_know() -> None:
    assert knows_masses(object())
    assert has_mass(object())
