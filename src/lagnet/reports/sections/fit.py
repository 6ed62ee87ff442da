"""How far the fit gets on recordings not used for it: before, after, and what noise alone would leave."""

from __future__ import annotations

import math
from typing import Any

from lagnet.reports.contents.findings import Findings
from lagnet.reports.figures.figure import Figure, Trace, axis, colour, names_axis, plain
from lagnet.reports.page import Section, section
from lagnet.reports.wording import percent, wrapped

KINDS = (
    ("nmse_nominal", "nominal model", "nominal"),
    ("nmse_named", "named", "corrected"),
    ("nmse_identified", "identified", "series-7"),
    ("nmse_full", "with learned remainder", "law"),
)
MEANING = {
    "nmse_named": "Named: with the effects that the verdict names.",
    "nmse_identified": "Identified: all that recordings determine, beside the named effects or in their place.",
    "nmse_full": "With learned remainder: with what is learned beyond that, where unseen motion gains from it.",
}
NAME_WIDTH = 20  # characters in a line
MOST_TICKS = 7  # whose percentages have room beside each other
SMALLEST = 1e-6  # a bar on a logarithmic axis cannot reach zero


def build(findings: Findings) -> Section | None:
    """Bars of every layer of the correction for each joint: the shorter, the better."""
    fits = findings.verdict["fit"]
    if not fits:
        return None
    kinds = layers_of(fits)
    meanings = [MEANING[key] for key, *_ in kinds if key in MEANING]
    figure = _figure(fits, kinds)
    return section("fit", "Fit on held-out recordings", [figure], half=True, fits=fits, kinds=kinds, meanings=meanings)


def layers_of(fits: list[dict[str, Any]]) -> list[tuple[str, str, str]]:
    """The nominal model, and the layers that change the error of some joint: an empty one has the error before it."""
    kinds, before = [KINDS[0]], KINDS[0][0]
    for kind in KINDS[1:]:
        if any(fit.get(kind[0]) is not None and fit[kind[0]] != fit[before] for fit in fits):
            kinds.append(kind)
            before = kind[0]
    return kinds


def _figure(fits: list[dict[str, Any]], kinds: list[tuple[str, str, str]]) -> Figure:
    names = ["<br>".join(plain(line) for line in wrapped(fit["joint"], NAME_WIDTH)) for fit in fits]
    traces = [
        {**_bars(names, [fit[key] for fit in fits], words, role), "legendrank": rank}
        for rank, (key, words, role) in enumerate(kinds)
    ]
    bars = [fit[key] for fit in fits for key, *_ in kinds if fit[key] is not None]
    lowest = max(min(bars) / 10, SMALLEST)  # a noise floor far below every bar must not crowd the bars
    traces.append(_floor(names, [fit["nmse_noise_floor"] for fit in fits], lowest))
    floors = [max(fit["nmse_noise_floor"], lowest) for fit in fits]
    layout = {
        "barmode": "group",
        "bargap": 0.28,
        "yaxis": names_axis(autorange="reversed"),
        "xaxis": axis("torque error (nMSE), logarithmic", "–", **_range([*bars, *floors])),
        "margin": {"t": 84},
    }
    lines = max(len(wrapped(fit["joint"], NAME_WIDTH)) for fit in fits)
    height = 170 + len(fits) * max(16 * lines + 8, 18 * len(kinds) + 14)
    return Figure("fit-bars", traces, "Held-out torque error of each joint before and after", layout, height)


def _bars(names: list[str], values: list[float | None], words: str, role: str) -> Trace:
    return {
        "type": "bar", "orientation": "h", "y": names, "name": words, "marker": {"color": colour(role)},
        "x": [None if value is None else max(value, SMALLEST) for value in values],
        "text": [percent(value) for value in values], "textposition": "inside", "insidetextanchor": "start",
        "hovertemplate": "%{y}: %{text}", "textangle": 0,
    }  # fmt: skip


def _floor(names: list[str], values: list[float], lowest: float) -> Trace:
    return {
        "type": "scatter", "mode": "markers", "y": names, "name": "noise floor",
        "x": [max(value, lowest) for value in values], "text": [percent(value) for value in values],
        "marker": {"symbol": "line-ns", "size": 22, "line": {"width": 3, "color": colour("ink")}},
        "hovertemplate": "%{y}: %{text}",
    }  # fmt: skip


def _range(values: list[float]) -> dict[str, Any]:
    """A logarithmic axis on which the shortest bar still has room for its number."""
    present = [math.log10(max(value, SMALLEST)) for value in values]
    high = max(max(present) + 0.1, 0.05)
    low = min(present) - max(0.4 * (high - min(present)), 0.3)
    decades = range(math.ceil(low), math.floor(high) + 1)
    ticks = [tick for tick in decades if tick % (1 + len(decades) // MOST_TICKS) == 0]
    return {
        "type": "log", "range": [low, high], "tickvals": [10.0**tick for tick in ticks],
        "ticktext": [f"{10.0 ** (tick + 2):.{max(0, -tick - 2)}f} %" for tick in ticks],
    }  # fmt: skip
