"""Errors of held-out rollouts joint by joint, and where they are large: by command step, speed and pose."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from lagnet.diagnosis.motion.diagnose import MotionDiagnosis
from lagnet.diagnosis.motion.problem import motion_rates
from lagnet.recordings.sampling import median_step
from lagnet.reports.figures.figure import Figure, axis, colour, packed
from lagnet.reports.page import Section, section

BINS = 12


def build(verdict: Mapping[str, Any], diagnosis: MotionDiagnosis) -> Section:
    """A table of root mean square errors, and for every joint the error against what it may depend on."""
    parts = [part for recording in diagnosis.holdout_recordings for part in recording.parts()]
    q = np.concatenate([part.q for part in parts])
    speed = np.concatenate([np.abs(motion_rates(part.time, part.q)[0]) for part in parts])
    step = np.concatenate([_command_step(np.array(part.command), part.time) for part in parts])
    figures = []
    for j, joint in enumerate(verdict["nominal"]["joints"]):
        errors = {
            "nominal": np.concatenate(diagnosis.nominal_rollouts)[:, j] - q[:, j],
            "corrected": np.concatenate(diagnosis.corrected_rollouts)[:, j] - q[:, j],
        }
        for key, words, unit, signal in (
            ("step", "largest command step of the last 0.3 s", "rad", step[:, j]),
            ("speed", "speed", "rad/s", speed[:, j]),
            ("pose", "position", "rad", q[:, j]),
        ):
            figures.append(_figure(f"motion-{key}-{j}", joint, words, unit, signal, errors))
    return section("motion_errors", "How far off", figures, fits=verdict["fit"], shown=figures)


def _command_step(command: np.ndarray, time: np.ndarray, span: float = 0.3) -> np.ndarray:
    """Range of the command over the last `span` seconds, shape (n, dof)."""
    count = max(2, round(span / median_step(time)))
    padded = np.vstack([np.repeat(command[:1], count - 1, axis=0), command])
    windows = np.lib.stride_tricks.sliding_window_view(padded, count, axis=0)
    return windows.max(axis=2) - windows.min(axis=2)


def _figure(
    key: str, joint: str, words: str, unit: str, signal: np.ndarray, errors: Mapping[str, np.ndarray]
) -> Figure:
    """Root mean square error in bins of equal numbers of samples."""
    edges = np.unique(np.quantile(signal, np.linspace(0.0, 1.0, BINS + 1)))
    index = np.clip(np.searchsorted(edges, signal, side="right") - 1, 0, max(len(edges) - 2, 0))
    counts = np.bincount(index, minlength=1)
    kept = counts > 0
    centre = np.bincount(index, weights=signal)[kept] / counts[kept]
    traces = []
    for kind, error in errors.items():
        rms = np.sqrt(np.bincount(index, weights=error**2)[kept] / counts[kept])
        line = {"type": "scatter", "mode": "lines+markers", "x": packed(centre), "y": packed(rms), "name": kind}
        traces.append({**line, "line": {"color": colour(kind)}, "hovertemplate": "%{y:.3g}"})
    layout = {"xaxis": axis(f"{joint}, {words}", unit), "yaxis": axis("error", "rad"), "margin": {"t": 30}}
    return Figure(key, traces, f"Error of position of {joint} against {words}", layout, 220)
