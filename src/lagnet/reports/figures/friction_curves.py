"""Identified friction of every joint over its speed, side by side: one small plot a joint."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
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


def friction_curves(findings: Findings, entries: Sequence[Mapping[str, Any]]) -> Figure | None:
    """Steady friction at no load beside what is named; None where no joint has a notable one.

    Args:
        findings: gives the units.
        entries: joints of the verdict's `identified`, each with its `friction_curve` of speed and torque.
    """
    shown = [entry for entry in entries if _is_notable(findings, entry)]
    if not shown:
        return None
    down = -(-len(shown) // ACROSS)
    across = -(-len(shown) // down)  # rows alike
    traces, layout = [], {"showlegend": False, "annotations": [], "margin": {"t": 34, "b": 52}}
    for number, entry in enumerate(shown):
        suffix = "" if number == 0 else str(number + 1)
        evidence = findings.evidence_on(entry["joint"])
        left, right, bottom, top = _place(number, across, down)
        force = "force" if evidence.unit == "N" else "torque"
        layout[f"xaxis{suffix}"] = axis("speed", evidence.velocity_unit, domain=[left, right], anchor=f"y{suffix}")
        layout[f"yaxis{suffix}"] = axis(force, evidence.unit, domain=[bottom, top], anchor=f"x{suffix}")
        layout["annotations"].append(_name(entry["joint"], left, top))
        traces.append(_curve(entry, suffix))
    height = 80 + ROW_HEIGHT * down
    return Figure("identified-friction", traces, "Identified friction of each joint over its speed", layout, height)


def _is_notable(findings: Findings, entry: Mapping[str, Any]) -> bool:
    """Whether the curve is a notable part of the joint's torque, as far as that is known."""
    size = float(np.max(np.abs(entry["friction_curve"]["torque"])))
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


def _curve(entry: Mapping[str, Any], suffix: str) -> Trace:
    curve = entry["friction_curve"]
    return {
        "type": "scatter", "mode": "lines", "x": packed(curve["speed"]), "y": packed(curve["torque"]),
        "name": plain(entry["joint"]),
        "xaxis": f"x{suffix}", "yaxis": f"y{suffix}",
        "line": {"color": colour("series-7"), "width": 3},
        "hovertemplate": "speed %{x:.3g}<br>friction %{y:.4g}<extra></extra>",
    }  # fmt: skip
