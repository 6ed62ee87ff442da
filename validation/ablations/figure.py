"""The study's figure: each figure of the diagnosis, whole and with one rule taken out."""

from __future__ import annotations

import json
from pathlib import Path
from textwrap import fill

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
from matplotlib.axes import Axes

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


def draw(result: Path, picture: Path) -> None:
    """Draw a result.json."""
    rules = json.loads(result.read_text())["rules"]
    figure, panels = plt.subplots(1, len(PANELS), figsize=(17.5, 0.9 + 0.38 * len(rules)), sharey=True)
    for axes, (name, title) in zip(panels, PANELS.items(), strict=True):
        _panel(axes, {rule: row["figures"][name] for rule, row in rules.items()})
        axes.set_title(title, fontsize=9)
    labels = ["whole diagnosis", *(f"without: {fill(rule.replace('_', ' '), 40)}" for rule in list(rules)[1:])]
    panels[0].set_yticks(range(len(rules)), labels)
    panels[0].invert_yaxis()
    figure.tight_layout()
    figure.savefig(picture, dpi=110)
    plt.close(figure)


def _panel(axes: Axes, values: dict[str, float | None]) -> None:
    """Dots, and a line at the value of the whole diagnosis."""
    whole = next(iter(values.values()))
    if whole is not None:
        axes.axvline(whole, color="gray", linewidth=0.8)
    for row, value in enumerate(values.values()):
        if value is not None:
            axes.plot([value], [row], "o", color="black" if row == 0 else "tab:red", clip_on=False, zorder=3)
            axes.annotate(f"{value:.3g}", (value, row), (4, 4), textcoords="offset points", fontsize=7)
    axes.margins(x=0.35)
    if not any(values.values()):
        axes.set_xlim(-0.2, 1.0)
    axes.grid(axis="y", alpha=0.3)
