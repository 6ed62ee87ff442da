"""Plants of the concealed study whose names were once wrong: hidden physics is found by its name."""

from __future__ import annotations

from pathlib import Path

import pytest
from validation.plants.catalogue.draw_plan import draw_plan
from validation.plants.catalogue.plan import Plan
from validation.plants.catalogue.simulate import simulate

from lagnet.diagnosis.diagnose import Diagnosis, diagnose
from lagnet.recordings.loading.load import load_recording
from lagnet.rigid_body.robot import load_description

pytestmark = pytest.mark.slow

SEED = 1122026
EVENT_THAT_IS_NONE, WRONG_NAMES_IN_A_WIDER_BAND, WORN_TRACK = 48, 143, 158


def diagnosed(plan: Plan, folder: Path) -> Diagnosis:
    simulate(plan, folder)
    robot = load_description(plan.robot)
    *fit, held = (load_recording(folder / f"{name}.csv", robot=robot) for name in plan.recordings)
    return diagnose(fit, robot, [held])


@pytest.mark.parametrize("number", [EVENT_THAT_IS_NONE, WRONG_NAMES_IN_A_WIDER_BAND])
def test_the_hidden_physics_is_named(tmp_path: Path, number: int) -> None:
    plan = draw_plan(SEED, number)
    found = diagnosed(plan, tmp_path)
    assert {(e.effect, e.joint) for e in found.effects} == {(h.effect, h.joint) for h in plan.hidden}


def test_friction_that_changes_along_the_path_is_no_stribeck_friction(tmp_path: Path) -> None:
    found = diagnosed(draw_plan(SEED, WORN_TRACK), tmp_path)
    assert ("stribeck_friction", "surrogate_terms") in {(r.effect, r.rule) for r in found.state.rejected}
    assert not {e.effect for e in found.effects} - {"coulomb_friction"}
