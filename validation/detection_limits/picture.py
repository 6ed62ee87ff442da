"""The study's figure: for every effect and condition, the sizes found in half and in 95 % of the plants."""

from __future__ import annotations

import json
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
from matplotlib.axes import Axes

HEIGHT = 0.18  # between the conditions of one effect


def draw(result: Path, picture: Path) -> None:
    """Draw a result.json."""
    curves = sorted(json.loads(result.read_text())["curves"], key=lambda c: c["effect"], reverse=True)
    conditions = sorted({(x["noise"], x["duration"]) for c in curves for x in c["limits"]})
    figure, axes = plt.subplots(figsize=(9, 1.2 + 0.42 * len(curves)))
    for i, (noise, duration) in enumerate(conditions):
        axes.plot([], [], "o-", color=f"C{i}", label=f"noise {100 * noise:g} %, 3 × {duration:g} s")
    for row, curve in enumerate(curves):
        for limit in curve["limits"]:
            i = conditions.index((limit["noise"], limit["duration"]))
            _bar(axes, curve, limit, row - (i - (len(conditions) - 1) / 2) * HEIGHT, f"C{i}")
    axes.set_yticks(range(len(curves)), [c["effect"].replace("_", " ") for c in curves])
    axes.set_xscale("log")
    axes.set_xlabel(
        "share of the joint's torque [%]: dot, found in half of the plants (thin line: 90 % interval);\n"
        "end of the thick line, found in 95 %; arrow, found or missed in every plant"
    )
    axes.legend(fontsize=8)
    axes.grid(axis="x", alpha=0.3)
    figure.tight_layout()
    figure.savefig(picture, dpi=110)
    plt.close(figure)


def _bar(axes: Axes, curve: dict, limit: dict, height: float, color: str) -> None:
    if limit["half"] is None:
        sizes = [100 * t["size"] for t in curve["trials"]]
        if sizes:  # found down to there every time, or missed up to there
            found = curve["trials"][0]["found"]
            axes.plot([min(sizes) if found else max(sizes)], [height], "<" if found else ">", color=color, alpha=0.6)
        return
    axes.plot([100 * x for x in limit["half_between"]], [height, height], "-", color=color, linewidth=0.8, alpha=0.6)
    axes.plot([100 * limit["half"], 100 * limit["most"]], [height, height], "-", color=color, linewidth=2.5)
    axes.plot([100 * limit["half"]], [height], "o", color=color, markersize=4)
