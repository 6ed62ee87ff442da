"""Where joints come to rest: error against command from above and from below, with the friction band drawn."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from lagnet.diagnosis.motion.diagnose import MotionDiagnosis
from lagnet.diagnosis.motion.joint.rest import at_rest
from lagnet.reports.figures.decimation import scattered
from lagnet.reports.figures.figure import Figure, axis, colour, packed
from lagnet.reports.page import Section, section

MOST = 600  # points of each side


def build(verdict: Mapping[str, Any], diagnosis: MotionDiagnosis) -> Section | None:
    """One plot for every joint that rests often enough for a band."""
    figures = []
    for j, found in enumerate(diagnosis.joints):
        if found is not None and found.rest is not None:
            figures.append(_figure(j, verdict["nominal"]["joints"][j], diagnosis, verdict["rest"][j]))
    return section("motion_rest", "Where it comes to rest", figures, shown=figures) if figures else None


def _figure(index: int, joint: str, diagnosis: MotionDiagnosis, band: Mapping[str, Any]) -> Figure:
    found, series = diagnosis.joints[index], diagnosis.problem.series[index]
    assert found is not None
    rows = np.flatnonzero(at_rest(series, 2.0 * found.case.floor))
    side = _came_from(series.q)[rows]
    traces = []
    for sign, words, role in ((1.0, "from below", "measured"), (-1.0, "from above", "accent")):
        own = rows[side == sign]
        own = own[scattered(len(own), MOST)]
        marks = {"color": colour(role), "size": 5}
        error = series.command[own] - series.q[own]
        trace = {"type": "scatter", "mode": "markers", "x": packed(series.load[own]), "y": packed(error)}
        traces.append({**trace, "name": words, "marker": marks, "hovertemplate": "%{y:.4g}"})
    load = np.linspace(float(series.load[rows].min()), float(series.load[rows].max()), 20)
    centre = band["bias"] + (band["compliance"] or 0.0) * load
    width = band["half_width"] + band["per_load"] * np.abs(load)
    for sign, words in ((1.0, "friction band"), (-1.0, "friction band, other side")):
        line = {"type": "scatter", "mode": "lines", "x": packed(load), "y": packed(centre + sign * width)}
        traces.append({**line, "name": words, "line": {"color": colour("law"), "width": 1.5}})
    layout = {"xaxis": axis("load of the nominal bodies", "N m"), "yaxis": axis(f"{joint}, u − q", "rad")}
    return Figure(f"motion-rest-{index}", traces, f"Rest positions of {joint} by direction of approach", layout, 280)


def _came_from(q: np.ndarray) -> np.ndarray:
    """Sign of the last movement before each sample, shape (n,)."""
    step = np.sign(np.diff(q, prepend=q[0]))
    last = np.maximum.accumulate(np.where(step != 0.0, np.arange(len(q)), 0))
    return step[last]
