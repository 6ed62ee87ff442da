"""Commanded, measured, nominal and corrected motion of every joint over the held-out recordings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from lagnet.diagnosis.motion.diagnose import MotionDiagnosis
from lagnet.reports.figures.decimation import extremes, series_budget
from lagnet.reports.figures.figure import SAME_X, Figure, axis, colour, packed
from lagnet.reports.page import Section, section

GAP = 1.0  # [s] between recordings that are drawn one after the other


def build(verdict: Mapping[str, Any], diagnosis: MotionDiagnosis) -> Section:
    """One plot a joint, recordings end to end."""
    parts = [part for recording in diagnosis.holdout_recordings for part in recording.parts()]
    time, start = [], 0.0
    for part in parts:
        time.append(part.time - part.time[0] + start)
        start = float(time[-1][-1]) + GAP
    clock = np.concatenate(time)
    kinds = {
        "command": np.concatenate([np.array(part.command) for part in parts]),
        "measured": np.concatenate([part.q for part in parts]),
        "nominal": np.concatenate(diagnosis.nominal_rollouts),
        "corrected": np.concatenate(diagnosis.corrected_rollouts),
    }
    joints = verdict["nominal"]["joints"]
    limit = max(series_budget(len(joints)) // 4, 200)
    figures = [_figure(j, joint, clock, kinds, limit) for j, joint in enumerate(joints)]
    return section("motion_curves", "Motion of held-out recordings", figures, shown=figures)


def _figure(index: int, joint: str, clock: np.ndarray, kinds: Mapping[str, np.ndarray], limit: int) -> Figure:
    rows = np.unique(np.concatenate([extremes(q[:, index], limit) for q in kinds.values()]))
    traces, x = [], packed(clock[rows])
    for kind, q in kinds.items():
        line = {"color": colour("noise" if kind == "command" else kind), "width": 2.5 if kind == "measured" else 1.5}
        trace = {"type": "scatter", "mode": "lines", "x": x, "y": packed(q[rows, index]), "name": kind, "line": line}
        traces.append({**trace, "hovertemplate": "%{y:.4g}"})
        x = SAME_X
    layout = {"xaxis": axis("time, recordings end to end", "s"), "yaxis": axis(joint, "rad"), "hovermode": "x"}
    return Figure(f"motion-{index}", traces, f"Commanded, measured and predicted motion of {joint}", layout, 260)
