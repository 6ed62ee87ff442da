"""Where the joints and their labels come to lie in a flat picture of the arm, to scale in both directions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lagnet.diagnosis.verdict.report_data import Skeleton

WIDTH, MARGIN, ARM_HEIGHT = 640.0, 34.0, 380.0
CHARACTER, LEADER = 8.8, 44.0  # width of a character of a label, at most; room for a leader on one side
RADIUS, LINE = 13.0, 18.0  # of a joint's circle; height of a line of words
ELEVATION = np.radians(18.0)  # looking slightly down, so that the base reads as ground


@dataclass(frozen=True)
class Label:
    """Lines of words beside the arm, tied to their joint by a leader."""

    lines: tuple[str, ...]
    x: float
    y: float  # of the first line
    anchor: str  # "end" on the left side, "start" on the right
    leader: tuple[float, float, float, float]


@dataclass(frozen=True)
class Drawing:
    """Picture coordinates, y downwards.

    Args:
        height: of the picture, whose width is WIDTH.
        links: the arm from base to tip, shape (dof + 2, 2).
        joints: centres of the joints' circles, shape (dof, 2); pushed apart where joints share a point.
        axes: ends of the stroke along each joint's axis, shape (dof, 4).
        labels: one a joint.
        scale_bar: its length in the picture and in metres; None for an arm without known geometry.
    """

    height: float
    links: np.ndarray
    joints: np.ndarray
    axes: np.ndarray
    labels: tuple[Label, ...]
    scale_bar: tuple[float, float] | None


def draw_arm(skeleton: Skeleton, lines: list[tuple[str, ...]]) -> Drawing:
    """Project an arm from the side that shows its joints best, with room for each joint's words."""
    azimuth = _best_azimuth(skeleton.points)
    flat = _project(skeleton.points, azimuth)
    span = np.maximum(np.ptp(flat, axis=0), 1e-6)
    words = max(len(line) for label in lines for line in label) * CHARACTER
    scale = float(min((WIDTH - 2 * (words + LEADER)) / span[0], ARM_HEIGHT / span[1]))
    centre = (flat.min(axis=0) + flat.max(axis=0)) / 2
    height = max(span[1] * scale, 160.0) + 2 * MARGIN
    links = (flat - centre) * scale * [1, -1] + [WIDTH / 2, height / 2]
    stroke = _project(skeleton.axes, azimuth) * [1, -1] * 30.0
    joints = _pushed_apart(links[1:-1])
    axes = np.hstack([joints - stroke, joints + stroke])
    return _labelled(height, links, joints, axes, lines, _scale_bar(scale))


def draw_chain(lines: list[tuple[str, ...]]) -> Drawing:
    """A column of joints from base (below) to tip, for a model without known geometry."""
    n = len(lines)
    height = 52.0 * (n + 1) + 2 * MARGIN
    y = np.linspace(height - MARGIN, MARGIN, n + 2)
    links = np.column_stack([np.full(n + 2, WIDTH / 2), y])
    return _labelled(height, links, links[1:-1], np.zeros((n, 4)), lines, None)


def _best_azimuth(points: np.ndarray) -> float:
    def spread(azimuth: float) -> float:
        flat = _project(points, azimuth)
        return float(np.sqrt(((flat[:, None] - flat[None]) ** 2).sum(axis=-1)).sum())

    return max(np.radians(np.arange(15, 360, 15)), key=spread)


def _project(points: np.ndarray, azimuth: float) -> np.ndarray:
    x = points[:, 0] * np.cos(azimuth) + points[:, 1] * np.sin(azimuth)
    depth = -points[:, 0] * np.sin(azimuth) + points[:, 1] * np.cos(azimuth)
    return np.column_stack([x, points[:, 2] * np.cos(ELEVATION) + depth * np.sin(ELEVATION)])


def _pushed_apart(centres: np.ndarray, distance: float = 2 * RADIUS + 2) -> np.ndarray:
    """Circles of joints that share a point, such as a spherical wrist's, side by side."""
    centres = centres + 1e-3 * np.arange(len(centres))[:, None] * [1.0, -0.5]
    for _ in range(200):
        gap = centres[:, None] - centres[None]
        length = np.linalg.norm(gap, axis=-1) + np.eye(len(centres)) * distance
        overlap = np.clip(distance - length, 0, None) / length
        if overlap.max(initial=0.0) < 1e-3:
            break
        centres = centres + 0.5 * (gap * overlap[..., None]).sum(axis=1)
    return centres


def _labelled(height, links, joints, axes, lines, scale_bar) -> Drawing:
    left = set(np.argsort(joints[:, 0], kind="stable")[: len(joints) // 2].tolist())
    labels: dict[int, Label] = {}
    needed = height
    for side in (left, set(range(len(joints))) - left):
        order = sorted(side, key=lambda i: joints[i, 1])
        heights = np.array([LINE * len(lines[i]) + 8 for i in order])
        centres = _stacked(joints[order, 1], heights)
        for i, y in zip(order, centres, strict=True):
            labels[i] = _label(lines[i], joints[i], float(y), side is left, links)
        if len(order):
            needed = max(needed, float(centres[-1] + heights[-1] / 2 + MARGIN))
    return Drawing(needed, links, joints, axes, tuple(labels[i] for i in range(len(joints))), scale_bar)


def _stacked(wanted: np.ndarray, heights: np.ndarray) -> np.ndarray:
    """Centres of labels near the wanted heights, none over another, none above the picture."""
    centres, bottom = [], 8.0
    for want, height in zip(wanted, heights, strict=True):
        centre = max(want, bottom + height / 2)
        centres.append(centre)
        bottom = centre + height / 2
    if not centres:
        return np.zeros(0)
    room_above = centres[0] - heights[0] / 2 - 8.0
    return np.array(centres) - min(float(np.mean(centres - wanted)), room_above)


def _label(words: tuple[str, ...], joint: np.ndarray, y: float, on_left: bool, links: np.ndarray) -> Label:
    edge = links[:, 0].min() - 34 if on_left else links[:, 0].max() + 34
    first = y - LINE * (len(words) - 1) / 2 + 5
    x = edge - 4 if on_left else edge + 4
    return Label(words, float(x), first, "end" if on_left else "start", (joint[0], joint[1], float(edge), y))


def _scale_bar(scale: float) -> tuple[float, float]:
    """A round length in metres that is about a sixth of the picture."""
    wanted = WIDTH / 6 / scale
    decade = 10.0 ** np.floor(np.log10(wanted))
    length = float(decade * max(step for step in (1, 2, 5) if step * decade <= wanted * 1.0001))
    return length * scale, length
