"""A DeLaN that learned the UR-5 passes; the same network trained on shuffled torques does not."""

from __future__ import annotations

from pathlib import Path

import pytest

from lagnet.models.saving import load_model
from lagnet.plausibility.settings import CheckSettings
from lagnet.plausibility.suite import check
from lagnet.rigid_body.robot import load_description

KEPT = Path(__file__).parents[1] / "models" / "fixtures"
LIGHT = CheckSettings(samples=48)


@pytest.mark.parametrize(("kept", "passes"), [("ur5_delan", True), ("ur5_shuffled", False)])
def test_trained_network_against_its_arm(kept, passes):
    report = check(load_model(KEPT / kept), reference=load_description("ur5"), settings=LIGHT)
    assert report.passed is passes, report.headline()
