"""Your simulator, before and after: trajectories laid over each other, error over time and by joint, horizon."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from lagnet.reports.decimation import extremes
from lagnet.reports.figures import SAME_X, Figure, Trace, axis, colour, names_axis, packed
from lagnet.reports.page import Section, section

POINTS = 12_000  # of all joints together
SMOOTH = 0.5  # [s] over which the error over time is a root mean square


@dataclass(frozen=True)
class ReplayData:
    """What a replay wrote.

    Args:
        summary: replay.json.
        columns: replay.parquet by column: recording, time, q_measured_i, q_before_i, q_after_i.
    """

    summary: Mapping[str, Any]
    columns: Mapping[str, Any]

    @property
    def joints(self) -> list[str]:
        """Joint names in model order."""
        return list(self.summary["joints"])

    @property
    def sides(self) -> tuple[str, ...]:
        """'before' and, where there is a corrected model, 'after'."""
        return ("before",) if self.summary["after"] is None else ("before", "after")

    def signal(self, name: str, joint: int, rows: np.ndarray) -> np.ndarray:
        """A column of a joint at some rows."""
        return np.asarray(self.columns[f"{name}_{joint}"], dtype=float)[rows]


ROLES = {"before": "nominal", "after": "corrected"}


def build(data: ReplayData) -> Section:
    """Figures of the longest stretch, errors of all."""
    rows = _longest(data)
    figures = [*_overlays(data, rows), _over_time(data, rows), _by_joint(data)]
    table = [
        {"joint": joint, **{side: data.summary[side]["rmse"][i] for side in data.sides}}
        for i, joint in enumerate(data.joints)
    ]
    return section(
        "your_simulator",
        "Your simulator, before and after",
        figures,
        overlays=figures[: len(data.joints)],
        errors=figures[len(data.joints) :],
        rows=table,
        sides=data.sides,
        summary=data.summary,
        horizons={side: data.summary[side].get("horizon_median_s") for side in data.sides},
    )


def _longest(data: ReplayData) -> np.ndarray:
    """Rows of the longest stretch of one recording whose clock runs on."""
    time = np.asarray(data.columns["time"], dtype=float)
    names = np.asarray(data.columns["recording"])
    breaks = np.flatnonzero((names[1:] != names[:-1]) | (np.diff(time) <= 0)) + 1
    return max(np.split(np.arange(time.size), breaks), key=len)


def _overlays(data: ReplayData, rows: np.ndarray) -> list[Figure]:
    time = np.asarray(data.columns["time"], dtype=float)[rows]
    out = []
    for i, joint in enumerate(data.joints):
        signals = {"measured": data.signal("q_measured", i, rows)}
        signals |= {side: data.signal(f"q_{side}", i, rows) for side in data.sides}
        limit = max(POINTS // (3 * len(data.joints)), 200)
        kept = np.unique(np.concatenate([extremes(s, limit) for s in signals.values()]))
        traces: list[Trace] = []
        for name, values in signals.items():
            x = packed(time[kept]) if not traces else SAME_X
            words = "real arm" if name == "measured" else f"simulated, {name}"
            role, width = ("measured", 2.5) if name == "measured" else (ROLES[name], 1.5)
            traces.append(_line(x, values[kept], words, role, width))
        form = {"xaxis": axis("time", "s"), "yaxis": axis(f"{joint}, position", "rad"), "hovermode": "x"}
        words = f"Position of {joint}, real and simulated"
        out.append(Figure(f"replay-{i}", traces, words, {**form, "margin": {"t": 36}}, 240))
    return out


def _over_time(data: ReplayData, rows: np.ndarray) -> Figure:
    """Root mean square over joints and half a second."""
    time = np.asarray(data.columns["time"], dtype=float)[rows]
    width = max(1, round(SMOOTH / max(float(np.median(np.diff(time))), 1e-9)))
    traces: list[Trace] = []
    for side in data.sides:
        power = np.mean(
            [
                (data.signal(f"q_{side}", i, rows) - data.signal("q_measured", i, rows)) ** 2
                for i in range(len(data.joints))
            ],
            axis=0,
        )
        smooth = np.sqrt(np.convolve(power, np.ones(width) / width, mode="same"))
        kept = extremes(smooth, 2000)
        traces.append(_line(packed(time[kept]), smooth[kept], side, ROLES[side], 2.0))
    form = {"xaxis": axis("time", "s"), "yaxis": axis("error, all joints", "rad", type="log"), "hovermode": "x"}
    return Figure("replay-over-time", traces, "Error of the simulation over time", {**form, "margin": {"t": 36}}, 260)


def _by_joint(data: ReplayData) -> Figure:
    traces: list[Trace] = [
        {
            "type": "bar",
            "x": data.joints,
            "y": list(data.summary[side]["rmse"]),
            "name": side,
            "marker": {"color": colour(ROLES[side])},
            "hovertemplate": "%{y:.3g} rad",
        }
        for side in data.sides
    ]
    form = {"xaxis": names_axis(), "yaxis": axis("error, root mean square", "rad"), "barmode": "group"}
    return Figure("replay-by-joint", traces, "Error of the simulation by joint", {**form, "margin": {"t": 36}}, 260)


def _line(x: Any, y: np.ndarray, name: str, role: str, width: float) -> Trace:
    return {
        "type": "scatter", "mode": "lines", "x": x, "y": packed(y), "name": name,
        "line": {"color": colour(role), "width": width}, "hovertemplate": "%{y:.4g}",
    }  # fmt: skip
