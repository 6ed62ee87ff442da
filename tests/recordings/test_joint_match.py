"""Which of a log's joints are the robot's."""

from __future__ import annotations

import pytest

from lagnet.recordings.loading.joint_match import match_joints

UR = ("shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint", "wrist_3_joint")
SEVEN = tuple(f"panda_joint{k}" for k in range(1, 8))


@pytest.mark.parametrize(
    ("log", "robot", "index", "how"),
    [
        (UR, UR[::-1], (5, 4, 3, 2, 1, 0), "name"),
        ((*UR, "gripper"), UR, (0, 1, 2, 3, 4, 5), "name"),
        (tuple(n.removesuffix("_joint").title() for n in UR), UR, (0, 1, 2, 3, 4, 5), "name"),
        (tuple(f"left/ur5_{n}" for n in UR), UR, (0, 1, 2, 3, 4, 5), "name without prefix"),
        (tuple(f"fer_joint{k}" for k in range(7, 0, -1)), SEVEN, (6, 5, 4, 3, 2, 1, 0), "name without prefix"),
        (UR, tuple(f"sim_{n}" for n in UR), (0, 1, 2, 3, 4, 5), "name without prefix"),
        (("a", "b"), ("x", "y"), (0, 1), "order"),
        (("a", "b", "c"), ("x", "y"), (None, None), ""),
        (UR[:5], UR, (0, 1, 2, 3, 4, None), "name"),
        (("b", "x"), ("a", "b"), (None, 0), "name"),
    ],
)
def test_matches(log: tuple[str, ...], robot: tuple[str, ...], index: tuple[int | None, ...], how: str) -> None:
    found = match_joints(log, robot)
    assert (found.index, found.how) == (index, how)
    assert found.complete == (bool(how) and None not in index)


def test_two_arms_fit_equally_well() -> None:
    log = tuple(f"{side}_{n}" for side in ("left", "right") for n in UR)
    found = match_joints(log, UR)
    assert found.ambiguous == ("left", "right")
    assert not found.complete
    assert match_joints(log, tuple(f"right_{n}" for n in UR)).index == (6, 7, 8, 9, 10, 11)


def test_unused_joints_are_told() -> None:
    assert match_joints(("finger", *SEVEN), SEVEN).unused == ("finger",)
