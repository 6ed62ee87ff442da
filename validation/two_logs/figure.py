"""The study's figure: what each route found of each cause, and what it claimed wrongly."""

from __future__ import annotations

import json
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np

ROUTES = {"urdf": "with the URDF", "simulated": "from a simulated log"}
WIDTH = 0.38


def draw(result: Path, picture: Path) -> None:
    """Draw a result.json."""
    content = json.loads(result.read_text())
    rows = content["by_effect"]
    kinds = [k for k in content["study"]["kinds"] if any(k in r for r in rows.values())]
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 3.8), width_ratios=[1.6, 1], layout="constrained")
    for i, (route, label) in enumerate(ROUTES.items()):
        asked = np.array([_count(rows[route], k, "hidden") - _count(rows[route], k, "not_shown") for k in kinds])
        found = np.array([_count(rows[route], k, "found") for k in kinds])
        at = np.arange(len(kinds)) + (i - 0.5) * WIDTH
        left.bar(at, found / np.maximum(asked, 1), WIDTH, label=label)
        for x, f, n in zip(at, found, asked, strict=True):
            left.text(x, 0.02, f"{f}/{n}", ha="center", color="white" if f else "black", fontsize=8)
        shares = [content["figures"][route][k] or 0.0 for k in ("precision", "recall", "right_joint")]
        right.bar(np.arange(3) + (i - 0.5) * WIDTH, shares, WIDTH, label=label)
        for x, share in zip(np.arange(3) + (i - 0.5) * WIDTH, shares, strict=True):
            right.text(x, share, f"{share:.3f}", ha="center", va="bottom", fontsize=8)
    left.set_xticks(range(len(kinds)), [k.replace("_", " ") for k in kinds], rotation=20, ha="right")
    left.set_ylabel("share found")
    right.set_xticks(range(3), ["precision", "recall", "right joint"])
    right.set_ylim(0, 1.12)
    right.legend(fontsize=8, loc="lower right")
    figure.savefig(picture, dpi=110)
    plt.close(figure)


def _count(rows: dict, kind: str, figure: str) -> int:
    return rows.get(kind, {}).get(figure, 0)
