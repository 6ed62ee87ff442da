"""A picture of the arm, each joint coloured by how much of its torque the nominal model does not foresee."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

from lagnet.reports.contents.findings import Findings
from lagnet.reports.figures.arm_drawing import MARGIN, RADIUS, WIDTH, draw_arm, draw_chain
from lagnet.reports.page import Section, section
from lagnet.reports.wording import percent, wrapped

AGREES = "#9db8b0"
# (upper limit of the nMSE, fill): light yellow to dark red, ordered also without hue
SCALE = ((0.01, "#ffffb2"), (0.03, "#fecc5c"), (0.1, "#fd8d3c"), (0.3, "#f03b20"), (float("inf"), "#a50026"))
LABEL_WIDTH = 20  # characters in a line


def build(findings: Findings) -> Section:
    """The arm in one pose, or a column of joints where its geometry is not known."""
    lines = [_words(findings, joint) for joint in findings.joints]
    skeleton = findings.evidence.skeleton
    if skeleton is not None and skeleton.points.shape != (len(lines) + 2, 3):
        skeleton = None  # not of this arm
    drawing = draw_chain(lines) if skeleton is None else draw_arm(skeleton, lines)
    return section(
        "arm",
        "Where it differs" if findings.differing else "The arm",
        half=True,
        drawing=drawing,
        joints=[_joint(findings, joint) for joint in findings.joints],
        legend=_legend(),
        width=WIDTH,
        margin=MARGIN,
        radius=RADIUS,
        known=skeleton is not None,
    )


def _words(findings: Findings, joint: str) -> tuple[str, ...]:
    share = percent(findings.mismatch(joint).get("nmse_nominal"))
    return (*wrapped(joint, LABEL_WIDTH), share if joint in findings.differing else f"{share} (noise)")


def _joint(findings: Findings, joint: str) -> dict[str, Any]:
    entry = findings.mismatch(joint)
    fill = _fill(entry.get("nmse_nominal", 0.0)) if entry.get("significant") else AGREES
    return {
        "name": joint,
        "fill": fill,
        "ink": "#ffffff" if fill in ("#f03b20", "#a50026") else "#1b1f24",
        "slides": findings.evidence_on(joint).unit == "N",
    }


def _fill(share: float) -> str:
    return next(fill for limit, fill in SCALE if share < limit or limit == float("inf"))


def _legend() -> list[dict[str, str]]:
    limits = [f"{100 * limit:g} %" for limit, _ in SCALE[:-1]]
    words = [f"< {limits[0]}", *(f"{a} – {b}" for a, b in pairwise(limits)), f"> {limits[-1]}"]
    steps = [{"fill": fill, "words": word} for (_, fill), word in zip(SCALE, words, strict=True)]
    return [{"fill": AGREES, "words": "within noise"}, *steps]
