"""Your simulator, before and after: trajectories laid over each other, error over time and by joint, horizon."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.stats import CensoredData, ecdf

from lagnet.recordings.sampling import median_step
from lagnet.reports.contents.findings import Findings
from lagnet.reports.contents.replay_data import ReplayData
from lagnet.reports.figures.decimation import extremes
from lagnet.reports.figures.figure import SAME_X, Figure, Trace, axis, colour, names_axis, packed, plain
from lagnet.reports.page import Section, section
from lagnet.reports.wording import wrapped

POINTS = 12_000  # of all joints together
NAME_WIDTH = 22  # letters of a joint's name on one line
SMOOTH = 0.5  # [s] over which the error over time is a root mean square
ROLES = {"before": "nominal", "after": "corrected"}
ENGINES = {"mujoco": "MuJoCo", "pybullet": "PyBullet"}
SHORT = {"margin": {"t": 36}}


def of_diagnosis(findings: Findings) -> Section | None:
    """The section of a diagnosis whose held-out recordings were replayed."""
    return None if findings.replay is None else build(findings.replay)


def build(data: ReplayData) -> Section:
    """Figures of the longest stretch, errors and horizons of all."""
    rows = data.longest()
    overlays = [_overlay(data, rows, index) for index in range(len(data.joints))]
    errors = [_by_joint(data), _over_time(data, rows), *_horizon(data)]
    return section(
        "your_simulator",
        "Your simulator, before and after",
        [*errors, *overlays],
        panels=[
            {"index": i, "joint": joint, "unit": data.units[i], "plot": overlays[i], "rmse": _errors(data, i)}
            for i, joint in enumerate(data.joints)
        ],
        first=_most_telling(data),
        errors=errors,
        sides=data.sides,
        summary=data.summary,
        engine=ENGINES.get(data.summary["engine"], data.summary["engine"]),
        tolerance=f"{data.summary['tolerance_rad']:g} {data.unit}",
        stretch={"recording": data.recording(rows), "seconds": float(np.ptp(data.time[rows]))},
        seconds=sum(r["seconds"] for r in data.summary["recordings"]),
        horizons={side: data.summary[side].get("horizon_median_s") for side in data.sides},
    )


def _errors(data: ReplayData, joint: int) -> dict[str, float]:
    return {side: float(data.summary[side]["rmse"][joint]) for side in data.sides}


def _most_telling(data: ReplayData) -> int:
    """The joint whose error falls most, or is largest."""
    errors = [_errors(data, i) for i in range(len(data.joints))]
    return int(np.argmax([e["before"] - e.get("after", 0.0) for e in errors]))


def _overlay(data: ReplayData, rows: np.ndarray, index: int) -> Figure:
    joint, time = data.joints[index], data.time[rows]
    signals = {"measured": data.signal("q_measured", index, rows)}
    signals |= {side: data.signal(f"q_{side}", index, rows) for side in data.sides}
    limit = max(POINTS // (3 * len(data.joints)), 200)
    kept = np.unique(np.concatenate([extremes(s, limit) for s in signals.values()]))
    traces: list[Trace] = []
    for name, values in signals.items():
        x = packed(time[kept]) if not traces else SAME_X
        words = "real arm" if name == "measured" else f"simulated, {name}"
        role, width = ("measured", 4.0) if name == "measured" else (ROLES[name], 1.5)
        traces.append(_line(x, values[kept], words, role, width))
    form = {"xaxis": axis("time", "s"), "yaxis": axis("position", data.units[index]), "hovermode": "x"}
    return Figure(f"replay-{index}", traces, f"Position of {joint}, real and simulated", {**form, **SHORT}, 260)


def _over_time(data: ReplayData, rows: np.ndarray) -> Figure:
    """Root mean square over joints and half a second."""
    time, joints = data.time[rows], range(len(data.joints))
    width = max(1, round(SMOOTH / max(median_step(time), 1e-9)))
    measured = [data.signal("q_measured", i, rows) for i in joints]
    traces: list[Trace] = []
    for side in data.sides:
        power = np.mean([(data.signal(f"q_{side}", i, rows) - measured[i]) ** 2 for i in joints], axis=0)
        count = np.convolve(np.ones_like(power), np.ones(width), mode="same")
        smooth = np.sqrt(np.convolve(power, np.ones(width), mode="same") / count)
        kept = extremes(smooth, 2000)
        traces.append(_line(packed(time[kept]), smooth[kept], side, ROLES[side], 2.0))
    decades = {"type": "log", "exponentformat": "power", "dtick": 1}
    form = {"xaxis": axis("time", "s"), "yaxis": axis("error, all joints", data.unit, **decades), "hovermode": "x"}
    return Figure("replay-over-time", traces, "Error of the simulation over time", {**form, **SHORT}, 280)


def _by_joint(data: ReplayData) -> Figure:
    """Lying bars, so that long names have room."""
    wrap = [wrapped(joint, NAME_WIDTH) for joint in data.joints]
    names = ["<br>".join(plain(line) for line in lines) for lines in wrap]
    traces: list[Trace] = [
        {
            "type": "bar",
            "orientation": "h",
            "y": names,
            "x": list(data.summary[side]["rmse"]),
            "name": side,
            "legendrank": rank,
            "marker": {"color": colour(ROLES[side])},
            "hovertemplate": f"%{{x:.3g}} {data.unit}",
        }
        for rank, side in enumerate(data.sides)
    ]
    form = {
        "xaxis": axis("error, rms", data.unit, rangemode="tozero"),
        "yaxis": names_axis(autorange="reversed"),
        "barmode": "group",
    }
    height = max(280, 100 + len(names) * (16 * max(map(len, wrap)) + 12))
    return Figure("replay-by-joint", traces, "Error of the simulation by joint", {**form, **SHORT}, height)


def _horizon(data: ReplayData) -> list[Figure]:
    """Share of rollouts still within the tolerance; those that were within at their end count until then."""
    if data.summary["before"].get("horizons_left") is None:
        return []
    traces: list[Trace] = []
    for side in data.sides:
        seconds = np.asarray(data.summary[side]["horizons_s"], dtype=float)
        stayed = ~np.asarray(data.summary[side]["horizons_left"], dtype=bool)
        curve = ecdf(CensoredData.right_censored(seconds, stayed)).sf
        x, share = np.r_[0.0, curve.quantiles], np.r_[1.0, curve.probabilities]
        line = _line(packed(x), 100.0 * share, side, ROLES[side], 2.0)
        traces.append(line | {"line": {**line["line"], "shape": "hv"}, "hovertemplate": "%{y:.0f} %"})
    within = f"rollouts within {data.summary['tolerance_rad']:g} {data.unit}"
    form = {"xaxis": axis("time since the start", "s"), "yaxis": axis(within, "%", range=[-4, 104]), "hovermode": "x"}
    words = "Share of rollouts that are still near the real arm, over time since their start"
    return [Figure("replay-horizon", traces, words, {**form, **SHORT}, 280)]


def _line(x: Any, y: np.ndarray, name: str, role: str, width: float) -> Trace:
    return {
        "type": "scatter", "mode": "lines", "x": x, "y": packed(y), "name": name,
        "line": {"color": colour(role), "width": width}, "hovertemplate": "%{y:.4g}",
    }  # fmt: skip
