"""What evidence for a surface rests on: blocks in which it acts, on two joints, on motion that was not fitted."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.motion.joint.joint_case import SelectionLimits
from lagnet.diagnosis.motion.surface.entry import NAME, surface_abstentions, surface_effects
from lagnet.diagnosis.motion.surface.evidence import LEAST_BLOCKS, Touched, pushed_joints, together
from lagnet.diagnosis.motion.surface.found import SurfaceFound
from lagnet.rigid_body.kinematic_tree import KinematicTree

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
    found = SurfaceFound(surface, "wrist", values, ends, named, 3, 6.0, (4e-4, 1e-4), 0.5, True)
    effects, abstentions = surface_effects(found), surface_abstentions(found)
    assert [e.effect for e in effects] == [NAME] * named
    assert [a.effect for a in abstentions] == [NAME] * (not named)
    text = effects[0].explanation if named else abstentions[0].reason
    assert "h = 0.012 m over the base's origin" in text
    assert "100 %" in text  # from 0.02 to 0.01
    if named:
        assert effects[0].value("k") == 900.0
        assert effects[0].evidence.log10_odds_over_best_rival > 0.0


def test_a_surface_that_pushes_one_joint_is_told_as_what_a_stop_may_be():
    values = dict.fromkeys(("px", "py", "pz", "h", "k", "mu"), 0.1)
    ends = dict.fromkeys(values, (0.0, 0.2))
    found = SurfaceFound(np.ones(7), "hip", values, ends, False, 1, 6.0, (4e-4, 1e-4), 0.5, True)
    assert "pushes one joint alone" in surface_abstentions(found)[0].reason


@pytest.mark.parametrize(
    ("body", "point", "pushed"),
    [(0, (0.3, 0.0, 0.0), 0), (1, (0.3, 0.0, -0.1), 1), (2, (0.3, 0.0, 0.0), 2), (2, (0.0, 0.0, 0.0), 1)],
    ids=["a turntable", "its first lift", "two lifts", "on the axis of the second"],
)
def test_joints_are_counted_that_a_vertical_force_at_the_point_turns(body: int, point: tuple[float, ...], pushed: int):
    axes, base = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 1.0, 0.0]]), np.full((3, 3), 0.2)
    still = {"bodies": np.zeros((3, 10)), "armature": np.zeros(3), "gravity": np.array([0.0, 0.0, -9.81])}
    turning = {"axes": axes, "sliding": np.zeros(3, dtype=bool)}
    tree = KinematicTree(np.array([-1, 0, 1]), np.tile(np.eye(3), (3, 1, 1)), base, **turning, **still)
    poses = np.random.default_rng(0).uniform(-1.0, 1.0, (200, 3))
    assert pushed_joints(tree, np.array([body, *point, 0.0, 1000.0, 0.2]), poses) == pushed


def test_without_one_nothing_is_told():
    assert surface_effects(None) == []
    assert surface_abstentions(None) == []
