"""Where real arm and simulator were run from the same commands: their torques laid over each other."""

from __future__ import annotations

from typing import Any

import numpy as np

from lagnet.diagnosis.nominal.log_alignment import SideBySide
from lagnet.reports.contents.findings import Findings
from lagnet.reports.figures.decimation import extremes
from lagnet.reports.figures.figure import SAME_X, Figure, Trace, axis, colour, packed
from lagnet.reports.page import Section, section

POINTS = 12_000  # of all joints together


def build(findings: Findings) -> Section | None:
    """A table of the pairs, and the curves of the longest, joint by joint."""
    pairs = findings.evidence.overlays
    if not pairs:
        return None
    shown = max(pairs, key=lambda pair: len(pair.time))
    figures = [_figure(findings, shown, index) for index in range(len(shown.joints))]
    return section(
        "overlay", "Real and simulated log, same commands", figures, rows=[_row(p) for p in pairs], shown=figures
    )


def _row(pair: SideBySide) -> dict[str, Any]:
    difference = np.sqrt(np.mean((pair.tau_real - pair.tau_simulated) ** 2, axis=0))
    share = difference / np.maximum(np.std(pair.tau_real, axis=0), 1e-12)
    worst = int(np.argmax(share))
    return {
        "real": pair.real,
        "simulated": pair.simulated,
        "lag": pair.lag,
        "seconds": float(pair.time[-1] - pair.time[0]),
        "worst": pair.joints[worst],
        "share": float(share[worst]),
    }


def _figure(findings: Findings, pair: SideBySide, index: int) -> Figure:
    joint, unit = pair.joints[index], findings.evidence_on(pair.joints[index]).unit
    real, simulated = pair.tau_real[:, index], pair.tau_simulated[:, index]
    limit = max(POINTS // (2 * len(pair.joints)), 200)
    rows = np.union1d(extremes(real, limit), extremes(simulated, limit))
    x = packed(pair.time[rows])
    traces = [
        _line(x, real[rows], "real arm", "measured", 2.5),
        _line(SAME_X, simulated[rows], "simulator", "nominal", 1.5),
    ]
    layout = {
        "xaxis": axis("time of the real log", "s"),
        "yaxis": axis(f"{joint}, {'force' if unit == 'N' else 'torque'}", unit),
        "margin": {"t": 36},
        "hovermode": "x",
    }
    return Figure(
        f"overlay-{index}", traces, f"Torque of {joint}, real and simulated, along the same commands", layout, 240
    )


def _line(x: Any, y: np.ndarray, name: str, role: str, width: float) -> Trace:
    return {
        "type": "scatter", "mode": "lines", "x": x, "y": packed(y), "name": name,
        "line": {"color": colour(role), "width": width}, "hovertemplate": "%{y:.4g}",
    }  # fmt: skip
