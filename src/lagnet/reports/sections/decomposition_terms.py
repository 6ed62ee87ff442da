"""Each term of each joint over time, predicted on reference."""

from __future__ import annotations

from typing import Any

import numpy as np

from lagnet.decomposition.decompose import Decomposition
from lagnet.reports.figures.figure import SAME_X, Figure, Trace, axis, colour, packed
from lagnet.reports.figures.timeline import Timeline, timeline
from lagnet.reports.page import Section, section
from lagnet.reports.wording import effect_words

SHOWN = ("total", "inertial", "coriolis", "gravity", "residual")
PAGE_POINTS = 40_000  # of all lines of the page: keeps it under a few megabytes
NEGLIGIBLE = 1e-9  # of the largest torque: rounding of a term that is not there
BAND = 2.0  # standard deviations of an ensemble's members


def build(parts: Decomposition) -> Section:
    """A panel for every joint, one of them shown at a time."""
    budget = max(200, min(2000, PAGE_POINTS // (parts.n_dof * len(SHOWN) * 2)))
    panels: list[dict[str, Any]] = []
    figures: list[Figure] = []
    for i, joint in enumerate(parts.joints):
        line = timeline(parts, parts.terms.total[:, i], budget)
        unit = "N" if parts.joint_types[i] == "prismatic" else "N m"
        own = [_figure(parts, line, i, name, unit) for name in SHOWN if _present(parts, name, i)]
        figures += own
        panels.append({"index": i, "joint": joint, "plots": own})
    absent = [name for name in SHOWN if not any(_present(parts, name, i) for i in range(parts.n_dof))]
    return section("decomposition_terms", "Joint by joint over time", figures, panels=panels, absent=absent)


def _present(parts: Decomposition, name: str, i: int) -> bool:
    """Whether a term is there at all, in the model or in the reference, beyond rounding."""
    models = [parts.terms] if parts.reference is None else [parts.terms, parts.reference]
    sizes = [np.abs(dict(m.items())[name][:, i]).max() / max(np.abs(m.total).max(), 1e-300) for m in models]
    return max(sizes) > NEGLIGIBLE


def _figure(parts: Decomposition, line: Timeline, i: int, name: str, unit: str) -> Figure:
    own = dict(parts.terms.items())[name][:, i]
    traces: list[Trace] = []
    band: list[Trace] = []
    if name == "total":
        traces.append(_line(line, parts.measured[:, i], "measured", "measured", 4.0))
    if parts.reference is not None:
        traces.append(_line(line, dict(parts.reference.items())[name][:, i], "reference", "nominal", 3.0))
    if parts.spread is not None:
        sd = BAND * parts.spread.of[name][:, i]
        band = [_band(line, own - sd, own + sd, parts.spread.members)]
    traces.append(_line(line, own, "model", "corrected", 1.5))
    for trace in traces[1:]:
        trace["x"] = SAME_X
    traces = band + traces
    words = effect_words(name)
    torque = axis(words, unit, exponentformat="power")
    layout = {"xaxis": axis("time, motions laid end to end", "s"), "yaxis": torque, "hovermode": "x"}
    return Figure(f"joint-{i}-{name}", traces, f"{words} torque of {parts.joints[i]} over time", layout, 260)


def _line(line: Timeline, values: np.ndarray, words: str, role: str, width: float) -> Trace:
    return {
        "type": "scatter", "mode": "lines", "x": packed(line.time), "y": packed(line.of(values)), "name": words,
        "connectgaps": False, "line": {"color": colour(role), "width": width}, "hovertemplate": "%{y:.4g}",
    }  # fmt: skip


def _band(line: Timeline, low: np.ndarray, high: np.ndarray, members: int) -> Trace:
    """One closed outline for every motion: there along the upper edge, back along the lower one."""
    time, below, above = line.time, line.of(low), line.of(high)
    x, y = [], []
    for own in np.split(np.arange(len(time)), np.flatnonzero(line.rows < 0)):
        rows = own[line.rows[own] >= 0]
        x += [time[rows], time[rows][::-1], [np.nan]]
        y += [above[rows], below[rows][::-1], [np.nan]]
    return {
        "type": "scatter", "mode": "lines", "x": packed(np.concatenate(x)), "y": packed(np.concatenate(y)),
        "fill": "toself", "line": {"width": 0}, "hoverinfo": "skip", "opacity": 0.4, "fillcolor": colour("noise"),
        "name": f"{BAND:.0f} sd of {members} members",
    }  # fmt: skip
