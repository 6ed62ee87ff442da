"""A DeLaN that learned the UR-5 breaks one exact symmetry and nothing else; one of shuffled torques breaks more."""

from __future__ import annotations

from pathlib import Path

from lagnet.models.saving import load_model
from lagnet.plausibility.settings import CheckSettings
from lagnet.plausibility.suite import check
from lagnet.rigid_body.robot import load_description

KEPT = Path(__file__).parents[1] / "models" / "fixtures"
LIGHT = CheckSettings(samples=48)


NOT_BUILT_IN = "base_angle_independence"  # exact for bodies; the network has learned its axes and misses it


def failures(kept: str) -> set[str]:
    report = check(load_model(KEPT / kept), reference=load_description("ur5"), settings=LIGHT)
    return {found.name for found in report.failures}


def test_trained_network_fails_only_the_symmetry_that_it_was_not_built_with():
    assert failures("ur5_delan") == {NOT_BUILT_IN}


def test_network_of_shuffled_torques_fails_every_conservative_term():
    assert {"reference_inertial", "reference_coriolis", "reference_gravity"} <= failures("ur5_shuffled")
