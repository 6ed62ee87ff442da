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
    curves = json.loads(result.read_text())["curves"]
    kinds = sorted({c["effect"] for c in curves}, reverse=True)
    conditions = sorted({(c["noise"], c["duration"]) for c in curves})
    figure, axes = plt.subplots(figsize=(9, 1 + 0.42 * len(kinds)))
    for i, condition in enumerate(conditions):
        color = f"C{i}"
        label = f"noise {100 * condition[0]:g} %, 3 × {condition[1]:g} s"
        axes.plot([], [], "o-", color=color, label=label)
        for curve in curves:
            if (curve["noise"], curve["duration"]) == condition:
                _bar(axes, curve, kinds.index(curve["effect"]) - (i - (len(conditions) - 1) / 2) * HEIGHT, color)
    axes.set_yticks(range(len(kinds)), [k.replace("_", " ") for k in kinds])
    axes.set_xscale("log")
    axes.set_xlabel("share of the joint's torque [%]: dot, found in half of the plants; end of the line, in 95 %")
    axes.legend(fontsize=8)
    axes.grid(axis="x", alpha=0.3)
    figure.tight_layout()
    figure.savefig(picture, dpi=110)
    plt.close(figure)


def _bar(axes: Axes, curve: dict, height: float, color: str) -> None:
    if curve["half"] is None:
        sizes = [100 * t["size"] for t in curve["trials"]]
        if sizes:  # an arrow: found down to there every time, or missed up to there
            found = curve["trials"][0]["found"]
            axes.plot([min(sizes) if found else max(sizes)], [height], "<" if found else ">", color=color, alpha=0.6)
        return
    axes.plot([100 * curve["half"], 100 * curve["most"]], [height, height], "-", color=color)
    axes.plot([100 * curve["half"]], [height], "o", color=color)
