"""The picture of an arm is to scale, its circles and labels lie beside one another, and nothing is cut."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lagnet.diagnosis.verdict.report_data import Skeleton
from lagnet.reports.figures.arm_drawing import CHARACTER, ELEVATION, LINE, RADIUS, WIDTH, draw_arm, draw_chain

ROUNDING = 1e-9  # of a few sums in picture coordinates of order 1e3


def skeleton(n: int, seed: int) -> Skeleton:
    rng = np.random.default_rng(seed)
    points = np.vstack([np.zeros(3), np.cumsum(rng.normal(0, 0.3, (n + 1, 3)), axis=0)])
    return Skeleton(points, np.tile([0.0, 0.0, 1.0], (n, 1)))


def words(n: int) -> list[tuple[str, ...]]:
    return [(f"joint_{i}_of_a_long", "name", "12 %") for i in range(n)]


def label_boxes(drawing, lines) -> list[tuple[float, float, float, float]]:
    """(left, right, top, bottom) of each label."""
    boxes = []
    for label in drawing.labels:
        width = CHARACTER * max(map(len, label.lines))
        left = label.x - width if label.anchor == "end" else label.x
        boxes.append((left, left + width, label.y - LINE + 4, label.y + LINE * (len(label.lines) - 1) + 4))
    return boxes


@given(st.integers(1, 8), st.integers(0, 200))
def test_labels_are_whole_and_apart(n, seed):
    drawing = draw_arm(skeleton(n, seed), words(n))
    boxes = label_boxes(drawing, words(n))
    for i, (left, right, top, bottom) in enumerate(boxes):
        assert left >= 0
        assert right <= WIDTH
        assert top >= 0
        assert bottom <= drawing.height
        for other in boxes[:i]:
            assert left >= other[1] or other[0] >= right or top >= other[3] - ROUNDING or other[2] >= bottom - ROUNDING


@given(st.floats(0.1, 3.0), st.floats(0.1, 3.0))
def test_one_scale_holds_upwards_and_sideways(up, along):
    """From whichever side an upright and a level link are seen, both give the metre of the scale bar."""
    points = np.array([[0, 0, 0], [0, 0, up], [along, 0, up]])
    drawing = draw_arm(Skeleton(points, np.array([[0.0, 1.0, 0.0]])), words(1))
    pixels_per_metre = drawing.scale_bar[0] / drawing.scale_bar[1]
    upright, level = np.diff(drawing.links, axis=0) / pixels_per_metre
    assert upright == pytest.approx([0, -up * np.cos(ELEVATION)], abs=ROUNDING)
    assert np.hypot(level[0], level[1] / np.sin(ELEVATION)) == pytest.approx(along, rel=ROUNDING)


def test_joints_that_share_a_point_are_drawn_side_by_side():
    points = np.array([[0, 0, 0], [0, 0, 0.5], [0, 0, 0.5], [0, 0, 0.5], [0.3, 0, 0.5]])
    drawing = draw_arm(Skeleton(points, np.eye(3)), words(3))
    for i in range(3):
        for j in range(i):
            assert np.linalg.norm(drawing.joints[i] - drawing.joints[j]) >= 2 * RADIUS


@pytest.mark.parametrize("n", [1, 8])
def test_a_chain_without_geometry_rises_from_its_base(n):
    drawing = draw_chain(words(n))
    assert np.all(np.diff(drawing.links[:, 1]) < 0)
    assert drawing.scale_bar is None
    assert len(drawing.labels) == n


def test_an_arm_of_one_point_does_not_fail():
    drawing = draw_arm(Skeleton(np.zeros((3, 3)), np.array([[0.0, 0.0, 1.0]])), words(1))
    assert np.isfinite(drawing.links).all()
