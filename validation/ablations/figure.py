"""The study's figure: each figure of the diagnosis, whole and with one rule taken out."""

from __future__ import annotations

import json
from pathlib import Path
from textwrap import fill

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

PANELS = {
    "precision": "precision",
    "recall": "recall",
    "right_joint": "right joint",
    "interval_coverage": "intervals that\nhold the truth",
    "median_parameter_error": "median error of\nparameters",
    "unlisted_given_a_wrong_name": "unlisted physics\nwrongly named",
    "claims_on_plants_with_nothing_hidden": "claims where\nnothing is hidden",
    "mismatch_told_where_nothing_is_hidden": "mismatch told where\nnothing is hidden",
}


COLOURS = {"simulated": "tab:blue", "textured": "tab:red"}


def draw(result: Path, picture: Path) -> None:
    """Draw a result.json."""
    rules = json.loads(result.read_text())["rules"]
    figure, panels = plt.subplots(1, len(PANELS), figsize=(17.5, 0.9 + 0.38 * len(rules)), sharey=True)
    for axes, (name, title) in zip(panels, PANELS.items(), strict=True):
        for kind, colour in COLOURS.items():
            _dots(axes, [row[kind]["figures"][name] if kind in row else None for row in rules.values()], colour)
        axes.set_title(title, fontsize=9)
        axes.margins(x=0.35)
        axes.grid(axis="y", alpha=0.3)
    labels = ["whole diagnosis", *(f"without: {fill(rule.replace('_', ' '), 40)}" for rule in list(rules)[1:])]
    panels[0].set_yticks(range(len(rules)), labels)
    panels[0].invert_yaxis()
    figure.legend([Line2D([], [], color=c, marker="o", ls="") for c in COLOURS.values()], COLOURS, loc="upper left")
    figure.tight_layout()
    figure.savefig(picture, dpi=110)
    plt.close(figure)


def _dots(axes: Axes, values: list[float | None], colour: str) -> None:
    """Dots, and a line at the value of the whole diagnosis."""
    if values[0] is not None:
        axes.axvline(values[0], color=colour, linewidth=0.6, alpha=0.6)
    known = [(value, row) for row, value in enumerate(values) if value is not None]
    if known:
        axes.plot(*zip(*known, strict=True), "o", color=colour, markersize=4, clip_on=False, zorder=3)
