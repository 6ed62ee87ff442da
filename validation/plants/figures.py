"""Pictures of a study's result: what was named as what, and parameter errors."""

from __future__ import annotations

import json
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np


def draw(result: Path, picture: Path) -> None:
    """Confusion matrix and parameter errors of a result.json, side by side."""
    content = json.loads(result.read_text())
    figure, (left, right) = plt.subplots(1, 2, figsize=(14, 6.5), width_ratios=[1.3, 1])
    _confusion(left, content["confusion"])
    _errors(right, content["plants"])
    figure.tight_layout()
    figure.savefig(picture, dpi=110)
    plt.close(figure)


def _confusion(axes: plt.Axes, table: dict[str, dict[str, int]]) -> None:
    rows = sorted(table, key=lambda name: (name == "nothing", name))
    columns = rows + sorted({name for row in table.values() for name in row} - set(rows))
    columns = [c for c in columns if c != "nothing"] + ["nothing"]
    counts = np.array([[table[r].get(c, 0) for c in columns] for r in rows], dtype=float)
    axes.imshow(counts / counts.sum(axis=1, keepdims=True), cmap="Blues", vmin=0, vmax=1, aspect="auto")
    for (i, j), count in np.ndenumerate(counts):
        if count:
            axes.text(
                j, i, f"{count:.0f}", ha="center", va="center", color="black" if count < counts[i].sum() / 2 else "w"
            )
    axes.set_xticks(range(len(columns)), [c.replace("_", " ") for c in columns], rotation=60, ha="right")
    axes.set_yticks(range(len(rows)), [r.replace("_", " ") for r in rows])
    axes.set_xlabel("named")
    axes.set_ylabel("hidden")


def _errors(axes: plt.Axes, plants: list[dict]) -> None:
    errors: dict[str, list[float]] = {}
    for plant in plants:
        for name, error in plant["errors"].items():
            errors.setdefault(name, []).append(100 * error)
    for row, name in enumerate(sorted(errors, reverse=True)):
        axes.plot(np.maximum(errors[name], 1e-3), np.full(len(errors[name]), row), "o", alpha=0.5, color="tab:blue")
    axes.set_yticks(range(len(errors)), sorted(errors, reverse=True))
    axes.set_xscale("log")
    axes.axvline(1.0, color="gray", linestyle=":")
    axes.set_xlabel("parameter error [%]")
