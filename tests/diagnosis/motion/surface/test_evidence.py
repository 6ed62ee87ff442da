"""What evidence for a surface rests on: blocks in which it acts, on two joints, on motion that was not fitted."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.motion.joint.joint_case import SelectionLimits
from lagnet.diagnosis.motion.surface.entry import NAME, surface_abstentions, surface_effects
from lagnet.diagnosis.motion.surface.evidence import LEAST_BLOCKS, Touched, together
from lagnet.diagnosis.motion.surface.found import SurfaceFound

LIMITS = SelectionLimits()
GAINS = np.random.default_rng(0).uniform(0.5, 1.5, 12)


def blocks(gains: np.ndarray, joints: int = 2, left: float = 0.1) -> Touched:
    moved = np.zeros((len(gains), 3), dtype=bool)
    moved[:, :joints] = True
    squares = np.column_stack([4.0 * np.ones(len(gains)), np.ones(len(gains)), left * np.ones(len(gains))])
    return Touched(gains, np.zeros(len(gains)), moved, squares)


def test_a_gain_in_many_blocks_on_two_joints_is_a_claim():
    judged = blocks(GAINS)
    assert judged.helps(LIMITS)
    assert judged.is_named(LIMITS)
    assert judged.left == pytest.approx(np.sqrt(0.1))


@pytest.mark.parametrize(
    "judged",
    [blocks(GAINS[: LEAST_BLOCKS - 1]), blocks(GAINS, joints=1), blocks(GAINS, left=0.99), blocks(GAINS[:0])],
    ids=["few blocks", "one joint, as a stop", "errors as large", "never"],
)
def test_else_the_correction_does_without_it(judged):
    assert not judged.helps(LIMITS)


@pytest.mark.parametrize(
    "judged",
    [blocks(np.where(np.arange(12) % 2, 3.0, -2.0)), blocks(GAINS, left=0.6)],
    ids=["within its scatter", "most is left"],
)
def test_what_helps_is_not_yet_a_claim(judged):
    assert judged.helps(LIMITS)
    assert not judged.is_named(LIMITS)


def test_parts_are_counted_together():
    both = together([blocks(GAINS), blocks(GAINS[:3])])
    assert len(both.without) == 15
    assert both.squares.shape == (15, 3)


@pytest.mark.parametrize("named", [True, False])
def test_it_is_an_effect_or_an_abstention_with_its_height(named):
    values = {"px": 0.0, "py": 0.0, "pz": -0.1, "h": 0.012, "k": 900.0, "mu": 0.2}
    ends = {n: (x - 0.01, x + 0.01) for n, x in values.items()}
    surface = np.array([1.0, *values.values()])
    found = SurfaceFound(surface, "wrist", values, ends, named, 6.0, (4e-4, 1e-4), 0.5, True)
    effects, abstentions = surface_effects(found), surface_abstentions(found)
    assert [e.effect for e in effects] == [NAME] * named
    assert [a.effect for a in abstentions] == [NAME] * (not named)
    text = effects[0].explanation if named else abstentions[0].reason
    assert "h = 0.012 m over the base's origin" in text
    assert "100 %" in text  # from 0.02 to 0.01
    if named:
        assert effects[0].value("k") == 900.0
        assert effects[0].evidence.log10_odds_over_best_rival > 0.0


def test_without_one_nothing_is_told():
    assert surface_effects(None) == []
    assert surface_abstentions(None) == []
