"""The study's figure: what was named as what, and how large an effect must be to be found."""

from __future__ import annotations

import json
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes


def draw(result: Path, picture: Path) -> None:
    """Confusion matrix of a result.json, and parameter errors by effect."""
    content = json.loads(result.read_text())
    figure, (left, right) = plt.subplots(1, 2, figsize=(19, 10), width_ratios=[2.2, 1])
    _confusion(left, content["confusion"])
    _errors(right, content["plants"])
    figure.tight_layout()
    figure.savefig(picture, dpi=90)
    plt.close(figure)


def _order(name: str) -> tuple[bool, bool, str]:
    return name == "nothing", name.startswith("unlisted:"), name


def _confusion(axes: Axes, table: dict[str, dict[str, int]]) -> None:
    rows = sorted(table, key=_order)
    named = {name for row in table.values() for name in row} | {r for r in rows if not r.startswith("unlisted:")}
    columns = sorted(named, key=_order)
    counts = np.array([[table[r].get(c, 0) for c in columns] for r in rows], dtype=float)
    axes.imshow(counts / np.maximum(counts.sum(axis=1, keepdims=True), 1), cmap="Blues", vmin=0, vmax=1, aspect="auto")
    for (i, j), count in np.ndenumerate(counts):
        if count:
            dark = count > counts[i].sum() / 2
            axes.text(j, i, f"{count:.0f}", ha="center", va="center", color="white" if dark else "black")
    axes.set_xticks(range(len(columns)), [c.replace("_", " ") for c in columns], rotation=60, ha="right")
    axes.set_yticks(range(len(rows)), [r.replace("_", " ") for r in rows])
    axes.set_xlabel("named on the joint")
    axes.set_ylabel("hidden")


def _errors(axes: Axes, plants: list[dict]) -> None:
    errors: dict[str, list[float]] = {}
    for plant in plants:
        for name, error in plant["errors"].items():
            errors.setdefault(name, []).append(100 * error)
    names = sorted(errors, reverse=True)
    for row, name in enumerate(names):
        axes.plot(np.maximum(errors[name], 1e-3), np.full(len(errors[name]), row), "o", alpha=0.4, color="tab:blue")
    axes.set_yticks(range(len(names)), names)
    axes.set_xscale("log")
    axes.axvline(3.0, color="gray", linestyle=":")
    axes.set_xlabel("parameter error [%]")
