"""The two plots of a joint: torque over time, and what the model misses against velocity."""

from __future__ import annotations

from typing import Any

import numpy as np

from lagnet.diagnosis.verdict.report_data import HeldOutSeries, JointEvidence
from lagnet.reports.figures.decimation import broken, chosen_samples, cloud_budget, end_to_end, scattered, series_budget
from lagnet.reports.figures.figure import SAME_X, Figure, Trace, axis, colour, packed, plain
from lagnet.reports.wording import effect_words, file_name, listed, shortened

WINDOW, WINDOW_SHOWN_WHOLE = 20.0, 30.0  # seconds shown at first of a recording longer than the second figure
NAME_WIDTH = 24  # characters of a motion's name
MOTIONS_MARKED = 12  # more starts of motions than this would only clutter the plot


def torque_over_time(key: str, joint: JointEvidence, n_joints: int) -> Figure | None:
    """Measured torque on the held-out recordings, and that of the nominal model, the named effects and all layers."""
    series = joint.held_out
    if series is None or len(series.time) == 0:
        return None
    chosen = chosen_samples(series, series_budget(n_joints))
    time, starts, moved = end_to_end(series)
    x = packed(broken(time, series, chosen))
    traces = [
        {**_line(x, packed(broken(np.asarray(values), series, chosen)), role, 1.5 if n else 4.0), "name": words}
        for n, (words, role, values) in enumerate(_lines(series))
    ]
    for trace in traces[1:]:
        trace["x"] = SAME_X
    layout = {
        "xaxis": axis("time, motions laid end to end" if moved else "time", "s", **_window(series, time)),
        "yaxis": axis(_torque(joint), joint.unit),
        "shapes": _starts(starts),
        "annotations": _names(series, starts),
        "margin": {"t": 64 if series.names and len(starts) <= 4 else 40},
        "legend": {"y": 1.14 if series.names and len(starts) <= 4 else 1.02},
        "hovermode": "x",
    }
    return Figure(key, traces, f"Measured, nominal and corrected torque of {joint.joint} over time", layout)


def _lines(series: HeldOutSeries) -> list[tuple[str, str, Any]]:
    """Name, colour and values of each line; of the layers those that change the torque of this joint."""
    lines = [("measured", "measured", series.measured), ("nominal", "nominal", series.nominal)]
    if not np.array_equal(series.nominal, series.corrected):
        lines.append(("named", "corrected", series.corrected))
    if series.full is not None and not np.array_equal(series.full, series.corrected):
        lines.append(("all layers", "series-7", series.full))
    return lines


def residual_by_velocity(key: str, joint: JointEvidence, n_joints: int) -> Figure | None:
    """What each model misses at each velocity, and the friction law that was fitted to it."""
    cloud = joint.residual
    if cloud is None or len(cloud.velocity) == 0:
        return None
    chosen = scattered(len(cloud.velocity), cloud_budget(n_joints))
    x = packed(np.asarray(cloud.velocity)[chosen])
    traces = [_dots(x, packed(np.asarray(cloud.nominal)[chosen]), "nominal")]
    if not np.array_equal(cloud.nominal, cloud.corrected):
        named = _dots(SAME_X, packed(np.asarray(cloud.corrected)[chosen]), "corrected")
        traces.append({**named, "name": "residual, named"})
    if joint.law is not None:
        traces.append(_law(joint))
    layout = {
        "xaxis": axis("velocity", joint.velocity_unit),
        "yaxis": axis(f"residual {_torque(joint)}", joint.unit),
        "shapes": _noise_band(joint.noise_rms),
        "margin": {"t": 40},
        "showlegend": True,
        "hovermode": "closest",
    }
    return Figure(key, traces, f"Residual torque of {joint.joint} against its velocity", layout)


def _window(series: HeldOutSeries, time: np.ndarray) -> dict[str, Any]:
    """At first the stretch with the largest residual, with the whole below it to slide along."""
    if time[-1] - time[0] <= WINDOW_SHOWN_WHOLE:
        return {}
    edges = np.arange(time[0], time[-1] - WINDOW, WINDOW / 4)
    residual = np.nan_to_num(np.asarray(series.measured) - np.asarray(series.nominal))
    power = np.append(0.0, np.cumsum(residual**2))
    inside = power[np.searchsorted(time, edges + WINDOW)] - power[np.searchsorted(time, edges)]
    start = float(edges[np.argmax(inside)])
    return {"range": [start, start + WINDOW], "rangeslider": {"thickness": 0.14, "bgcolor": colour("panel")}}


def _torque(joint: JointEvidence) -> str:
    return "force" if joint.unit == "N" else "torque"


def _line(x: Any, y: Any, role: str, width: float) -> Trace:
    return {
        "type": "scatter", "mode": "lines", "x": x, "y": y, "name": role, "connectgaps": False,
        "line": {"color": colour(role), "width": width}, "hovertemplate": "%{y:.4g}",
    }  # fmt: skip


def _dots(x: Any, y: Any, role: str) -> Trace:
    return {
        "type": "scatter", "mode": "markers", "x": x, "y": y, "name": f"residual, {role}",
        "marker": {"color": colour(role), "size": 3.5, "opacity": 0.45},
        "hovertemplate": "velocity %{x:.3g}<br>residual %{y:.4g}<extra></extra>",
    }  # fmt: skip


def _law(joint: JointEvidence) -> Trace:
    assert joint.law is not None
    words = listed([effect_words(name) for name in joint.law.effects]) or "friction"
    return {
        "type": "scatter", "mode": "lines", "x": packed(joint.law.velocity), "y": packed(joint.law.torque),
        "name": plain(f"fitted law: {words}"), "line": {"color": colour("law"), "width": 3},
        "hovertemplate": "velocity %{x:.3g}<br>law %{y:.4g}<extra></extra>",
    }  # fmt: skip


def _noise_band(noise_rms: float | None) -> list[dict[str, Any]]:
    if noise_rms is None or not np.isfinite(noise_rms):
        return []
    return [
        {
            "type": "rect", "xref": "paper", "x0": 0, "x1": 1, "y0": -2 * noise_rms, "y1": 2 * noise_rms,
            "fillcolor": colour("noise"), "opacity": 0.25, "line": {"width": 0}, "layer": "below",
        }
    ]  # fmt: skip


def _starts(starts: np.ndarray) -> list[dict[str, Any]]:
    if not 1 < len(starts) <= MOTIONS_MARKED:
        return []
    line = {"color": colour("line"), "width": 1, "dash": "dot"}
    return [
        {"type": "line", "x0": float(t), "x1": float(t), "yref": "paper", "y0": 0, "y1": 1, "line": line}
        for t in starts
    ]


def _names(series: HeldOutSeries, starts: np.ndarray) -> list[dict[str, Any]]:
    """The names of the motions above their starts, where they are few enough to stand side by side."""
    if len(series.names) != len(starts) or len(starts) > 4:
        return []
    return [
        {
            "x": float(t), "y": 1, "yref": "paper", "yanchor": "bottom", "xanchor": "left", "showarrow": False,
            "text": plain(shortened(file_name(name), NAME_WIDTH)), "font": {"size": 11, "color": colour("quiet")},
        }
        for t, name in zip(starts, series.names, strict=True)
    ]  # fmt: skip
