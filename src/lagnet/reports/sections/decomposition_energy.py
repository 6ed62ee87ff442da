"""Where the work goes: powers over time, and the balance of energy."""

from __future__ import annotations

import numpy as np

from lagnet.decomposition.decompose import Decomposition
from lagnet.decomposition.energies import work
from lagnet.reports.figures.figure import SAME_X, Figure, Trace, axis, colour, packed
from lagnet.reports.figures.timeline import Timeline, timeline
from lagnet.reports.page import Section, section

BUDGET = 2000


def build(parts: Decomposition) -> Section:
    """Energies of the model, and powers of model, residual and measurement."""
    energies = parts.energies
    line = timeline(parts, energies.model_power, BUDGET)
    stores = [
        _line(line, energies.kinetic, "kinetic", "series-1"),
        _line(line, energies.potential, "potential, from the start of each motion", "series-3"),
    ]
    flows = [
        _line(line, energies.measured_power, "measured torque", "measured"),
        _line(line, energies.model_power, "model torque", "corrected"),
        _line(line, energies.residual_power, "taken out by the residual", "series-2"),
    ]
    figures = [_figure("energy", stores, "energy", "J"), _figure("power", flows, "power", "W")]
    clock = parts.time, parts.trajectory
    figures_of_merit = {
        "measured": work(*clock, energies.measured_power),
        "model": work(*clock, energies.model_power),
        "residual": work(*clock, energies.residual_power),
        "imbalance": float(np.abs(energies.imbalance).max()),
    }
    return section("decomposition_energy", "Energy and power", figures, work=figures_of_merit)


def _figure(key: str, traces: list[Trace], quantity: str, unit: str) -> Figure:
    for trace in traces[1:]:
        trace["x"] = SAME_X
    layout = {"xaxis": axis("time, motions laid end to end", "s"), "yaxis": axis(quantity, unit), "hovermode": "x"}
    return Figure(key, traces, f"{quantity} along the motion", layout, 280)


def _line(line: Timeline, values: np.ndarray, words: str, role: str) -> Trace:
    return {
        "type": "scatter", "mode": "lines", "x": packed(line.time), "y": packed(line.of(values)), "name": words,
        "connectgaps": False, "line": {"color": colour(role), "width": 2}, "hovertemplate": "%{y:.4g}",
    }  # fmt: skip
