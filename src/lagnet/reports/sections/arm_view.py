"""The arm in motion: capsules that play a held-out recording, joints coloured by what is missing at that moment."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np

from lagnet.diagnosis.verdict.report_data import ArmMotion
from lagnet.reports.contents.findings import Findings
from lagnet.reports.page import Section, json_for_script, section

MOST = 2.0  # of the torque's scatter that fills the colours, at most
LEAST = 0.02  # and at least, so that noise is no colour
STEPS = 32_000  # of a joint's range, in 16 bits


def build(findings: Findings) -> Section | None:
    """The view, or nothing where the arm's geometry is not known."""
    motion = findings.evidence.motion
    if motion is None or len(motion.tree) != len(findings.joints):
        return None
    data = view_data(findings.joints, motion)
    return section(
        "arm_view", "The arm in motion", scripts=("arm_view.js",), data=json_for_script(data), frames=data["frames"]
    )


def view_data(joints: tuple[str, ...], motion: ArmMotion) -> dict[str, Any]:
    """What the script plays: the tree, angles in 16 and residuals in 8 bits."""
    middle = (motion.q.min(axis=0) + motion.q.max(axis=0)) / 2.0
    step = np.maximum(np.ptp(motion.q, axis=0) / 2.0, 1e-9) / STEPS
    angles = np.round((motion.q - middle) / step).astype("<i2")
    top = float(np.clip(np.max(np.quantile(motion.before, 0.99, axis=0)), LEAST, MOST))
    points = _reached(motion)
    centre = (points.min(axis=0) + points.max(axis=0)) / 2.0
    return {
        "joints": list(joints),
        "frames": len(motion.time),
        "seconds": float(motion.time[-1]),
        "tree": [_body(body) for body in motion.tree],
        "tip": _round(motion.tip),
        "middle": _round(middle, 7),
        "step": [float(x) for x in step],
        "angles": _text(angles),
        "before": _text(_bytes(motion.before, top)),
        "after": _text(_bytes(motion.after, top)),
        "top": top,
        "centre": _round(centre),
        "reach": float(max(np.ptp(points, axis=0).max() * 0.62, 1e-3)),
        "azimuth": 0.6,
    }


def _body(body: Any) -> dict[str, Any]:
    return {
        "parent": body.parent,
        "position": _round(body.position),
        "rotation": _round(body.rotation.ravel(), 7),
        "axis": _round(body.axis, 7),
        "slides": not body.turns,
    }


def _reached(motion: ArmMotion) -> np.ndarray:
    """Points of joints and tip over some frames, with the base, shape (m, 3)."""
    out = [np.zeros(3)]
    for q in motion.q[:: max(1, len(motion.q) // 24)]:
        placed: list[tuple[np.ndarray, np.ndarray]] = []
        for body, angle in zip(motion.tree, q, strict=True):
            p, r = (np.zeros(3), np.eye(3)) if body.parent < 0 else placed[body.parent]
            p, r = p + r @ body.position, r @ body.rotation
            placed.append((p, r @ _turn(body.axis, angle)) if body.turns else (p + r @ body.axis * angle, r))
            out.append(placed[-1][0])
        out.append(placed[-1][0] + placed[-1][1] @ motion.tip)
    return np.array(out)


def _turn(axis: np.ndarray, angle: float) -> np.ndarray:
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross


def _bytes(share: np.ndarray, top: float) -> np.ndarray:
    return np.round(np.clip(np.nan_to_num(share) / top, 0.0, 1.0) * 255.0).astype(np.uint8)


def _text(array: np.ndarray) -> str:
    return base64.b64encode(np.ascontiguousarray(array).tobytes()).decode("ascii")


def _round(values: np.ndarray, digits: int = 5) -> list[float]:
    return [round(float(v), digits) for v in np.ravel(values)]
