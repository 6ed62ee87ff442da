"""A plain law stays open to a wider one that would account for what it leaves, however little that is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.identifiability.rivals import compare_with_rivals

JOINT, DRY, QUIET = 1, 4.0, 5e-4


def told_open(arm, plant, at, law, motion: int = 1) -> set[str]:
    """Laws that Coulomb friction at the joint is tied with."""
    real = replace(plant(at(JOINT, law)), noise=QUIET)
    posed = pose(arm, real.record(motion), real.record(motion + 1))
    index = posed.index("coulomb_friction", JOINT)
    compared = compare_with_rivals(posed.equations, posed.select({JOINT: ["coulomb_friction"]}))
    return set(next(c for c in compared if c.index == index).tied)


@pytest.mark.parametrize(("extra", "is_open"), [(0.1, True), (0.0, False)])
def test_friction_that_is_a_little_larger_at_rest_may_be_coulombs_or_stribecks(arm, plant, at, extra, is_open) -> None:
    def law(q, v, a, tau):
        return (DRY + extra * DRY * np.exp(-((v / 0.1) ** 2))) * np.sign(v)

    assert ("stribeck_friction" in told_open(arm, plant, at, law)) == is_open


def test_what_no_further_term_accounts_for_opens_nothing(arm, plant, at) -> None:
    """Half of what is left is a ripple: friction that is larger at rest would account for less than the other half."""

    def law(q, v, a, tau):
        return (DRY + 0.1 * DRY * np.exp(-((v / 0.1) ** 2))) * np.sign(v) + 0.8 * np.sin(9.0 * q)

    assert "stribeck_friction" not in told_open(arm, plant, at, law)


@pytest.mark.parametrize(("extra", "is_open"), [(0.25, True), (0.4, True), (0.0, False)])
def test_beside_something_larger_that_no_law_has_a_further_term_of_size_stays_open(
    arm, plant, at, extra, is_open
) -> None:
    """The evidence tells neither law beside 1.5 N m of ripple; the further term gains 1 % of the friction's power."""

    def law(q, v, a, tau):
        return (DRY + extra * DRY * np.exp(-((v / 0.1) ** 2))) * np.sign(v) + 1.5 * np.sin(9.0 * q)

    assert ("stribeck_friction" in told_open(arm, plant, at, law, motion=10)) == is_open


def test_all_wider_laws_that_could_be_the_cause_are_told(arm, plant, at) -> None:
    """Beside 1.5 N m of ripple the further terms of two laws gain as much each: the better closes no other."""

    def law(q, v, a, tau):
        return (DRY + 0.3 * DRY * np.exp(-((v / 0.1) ** 2))) * np.sign(v) + 0.1 * DRY + 1.5 * np.sin(9.0 * q)

    assert {"stribeck_friction", "asymmetric_friction"} <= told_open(arm, plant, at, law, motion=10)
