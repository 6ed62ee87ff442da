"""A DeLaN that learned the UR-5 passes, and misses a symmetry if asked for it; one of shuffled torques fails."""

from __future__ import annotations

from pathlib import Path

import pytest

from lagnet.models.files.saving import load_model
from lagnet.plausibility.report import PlausibilityReport
from lagnet.plausibility.settings import CheckSettings
from lagnet.plausibility.suite import check
from lagnet.rigid_body.robot import load_description

pytestmark = pytest.mark.slow

KEPT = Path(__file__).parents[1] / "models" / "fixtures"


def report(kept: str, vertical_base: bool = False) -> PlausibilityReport:
    settings = CheckSettings(samples=48, vertical_base=vertical_base)
    return check(load_model(KEPT / kept), reference=load_description("ur5"), settings=settings)


def test_trained_network_passes_all_that_is_checked_unasked():
    found = report("ur5_delan")
    assert found.passed, found.headline()
    assert found["reference_total"].status == "pass", "a residual that is zero is no residual"
    assert found["base_angle_independence"].status == "not_applicable"
    assert "--vertical-base" in found["base_angle_independence"].detail


def test_asked_for_the_symmetry_of_its_base_it_fails_at_the_limit_of_exact_models():
    found = report("ur5_delan", vertical_base=True)
    assert [c.name for c in found.failures] == ["base_angle_independence"]
    assert found["base_angle_independence"].limit == 1e-7


def test_network_of_shuffled_torques_fails_every_conservative_term():
    failed = {found.name for found in report("ur5_shuffled").failures}
    assert {"reference_inertial", "reference_coriolis", "reference_gravity"} <= failed
