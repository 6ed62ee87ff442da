"""Plants of the concealed study whose names were once wrong: hidden physics is found by its name."""

from __future__ import annotations

from pathlib import Path

import pytest
from validation.plants.catalogue.draw_plan import draw_plan
from validation.plants.catalogue.simulate import simulate

from lagnet.diagnosis.diagnose import diagnose
from lagnet.recordings.loading.load import load_recording
from lagnet.rigid_body.robot import load_description

pytestmark = pytest.mark.slow

SEED = 1122026
EVENT_THAT_IS_NONE, WRONG_NAMES_IN_A_WIDER_BAND = 48, 143


@pytest.mark.parametrize("plant", [EVENT_THAT_IS_NONE, WRONG_NAMES_IN_A_WIDER_BAND])
def test_the_hidden_physics_is_named(tmp_path: Path, plant: int) -> None:
    plan = draw_plan(SEED, plant)
    simulate(plan, tmp_path)
    robot = load_description(plan.robot)
    *fit, held = (load_recording(tmp_path / f"{name}.csv", robot=robot) for name in plan.recordings)
    found = diagnose(fit, robot, [held])
    assert {(e.effect, e.joint) for e in found.effects} == {(h.effect, h.joint) for h in plan.hidden}
