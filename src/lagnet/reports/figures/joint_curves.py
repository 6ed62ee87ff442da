"""Identified friction of every joint over its speed, and torque over its position: one small plot a joint."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from lagnet.reports.contents.findings import Findings
from lagnet.reports.figures.figure import Figure, Trace, axis, colour, packed, plain
from lagnet.reports.wording import shortened

ACROSS = 4  # plots in a row, at most
ROW_HEIGHT = 210  # [CSS px]
GAP_ACROSS, GAP_DOWN = 0.09, 0.2  # between plots, in parts of the whole; down: for two rows
NOTABLE = 0.02  # of a joint's usual torque: a smaller curve is not worth a plot
NAME_WIDTH = 30  # characters in a line above a plot


@dataclass(frozen=True)
class Line:
    """One line of a plot: key of its values in the curve, what it is called, and its style."""

    values: str
    words: str
    role: str = "series-7"
    dash: str = "solid"


@dataclass(frozen=True)
class CurveKind:
    """Curves of one kind.

    Args:
        entry: key in a joint's entry of the verdict's `identified`.
        key, description: of the figure.
        over: key of what the curves are over, which is also its name; per_second: whether that is a speed.
        lines: of each plot.
    """

    entry: str
    key: str
    description: str
    over: str
    per_second: bool
    lines: tuple[Line, ...]


FRICTION = CurveKind(
    "friction_curve", "identified-friction", "Identified friction of each joint over its speed",
    "speed", True, (Line("torque", "friction"),),
)  # fmt: skip
OVER_POSITION = CurveKind(
    "curve_over_position", "identified-position", "Identified torque and friction of each joint over its position",
    "position", False, (Line("torque", "torque at any speed"), Line("friction", "friction", "series-2", "dash")),
)  # fmt: skip


def joint_curves(findings: Findings, entries: Sequence[Mapping[str, Any]], kind: CurveKind) -> Figure | None:
    """Steady curves beside what is named; None where no joint has a notable one.

    Args:
        findings: gives the units.
        entries: joints of the verdict's `identified`, with their curves.
        kind: which curves.
    """
    shown = [entry for entry in entries if kind.entry in entry and _is_notable(findings, entry, kind)]
    if not shown:
        return None
    down = -(-len(shown) // ACROSS)
    across = -(-len(shown) // down)  # rows alike
    traces: list[Trace] = []
    layout: dict[str, Any] = {"showlegend": False, "annotations": [], "margin": {"t": 34, "b": 52}}
    for number, entry in enumerate(shown):
        suffix = "" if number == 0 else str(number + 1)
        evidence = findings.evidence_on(entry["joint"])
        left, right, bottom, top = _place(number, across, down)
        force = "force" if evidence.unit == "N" else "torque"
        unit = evidence.velocity_unit if kind.per_second else evidence.velocity_unit.split("/")[0]
        layout[f"xaxis{suffix}"] = axis(kind.over, unit, domain=[left, right], anchor=f"y{suffix}")
        layout[f"yaxis{suffix}"] = axis(force, evidence.unit, domain=[bottom, top], anchor=f"x{suffix}")
        layout["annotations"].append(_name(entry["joint"], left, top))
        traces += [_curve(entry, kind, line, suffix) for line in kind.lines]
    height = 80 + ROW_HEIGHT * down
    return Figure(kind.key, traces, kind.description, layout, height)


def _is_notable(findings: Findings, entry: Mapping[str, Any], kind: CurveKind) -> bool:
    """Whether the curve is a notable part of the joint's torque, as far as that is known."""
    size = float(max(np.max(np.abs(entry[kind.entry][line.values])) for line in kind.lines))
    series = findings.evidence_on(entry["joint"]).held_out
    usual = 0.0 if series is None or len(series.measured) == 0 else float(np.nanstd(np.asarray(series.measured)))
    return size > NOTABLE * usual


def _place(number: int, across: int, down: int) -> tuple[float, float, float, float]:
    """Left, right, bottom and top of a plot in parts of the whole."""
    row, column = divmod(number, across)
    gap = GAP_DOWN * 2 / max(down, 2) * (down > 1)
    width, height = (1 - GAP_ACROSS * (across - 1)) / across, (1 - gap * (down - 1)) / down
    left, top = column * (width + GAP_ACROSS), 1 - row * (height + gap)
    return left, min(left + width, 1.0), max(top - height, 0.0), top


def _name(joint: str, left: float, top: float) -> dict[str, Any]:
    return {
        "text": plain(shortened(joint, NAME_WIDTH)), "showarrow": False,
        "x": left, "y": top, "xref": "paper", "yref": "paper", "xanchor": "left", "yanchor": "bottom",
        "font": {"size": 12, "color": colour("ink")},
    }  # fmt: skip


def _curve(entry: Mapping[str, Any], kind: CurveKind, line: Line, suffix: str) -> Trace:
    curve = entry[kind.entry]
    return {
        "type": "scatter", "mode": "lines", "x": packed(curve[kind.over]), "y": packed(curve[line.values]),
        "name": plain(entry["joint"]),
        "xaxis": f"x{suffix}", "yaxis": f"y{suffix}",
        "line": {"color": colour(line.role), "width": 3, "dash": line.dash},
        "hovertemplate": f"{kind.over} %{{x:.3g}}<br>{line.words} %{{y:.4g}}<extra></extra>",
    }  # fmt: skip
