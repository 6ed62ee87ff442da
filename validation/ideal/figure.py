"""Bars as in Fig. 4 of the paper: normalised mean squared error of each term on each joint, model by model."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from validation.ideal.terms import TERMS


def draw_figure(models: dict[str, Any], path: Path) -> None:
    """One panel a term, one group of bars a joint, logarithmic; joints that do not carry a term stay empty."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(1, len(TERMS), figsize=(14, 4.2), sharey=True, layout="constrained")
    width = 0.8 / len(models)
    for axis, term in zip(axes, TERMS, strict=True):
        for place, (kind, found) in enumerate(models.items()):
            errors = [np.nan if e is None else e for e in found["median"][term]]
            axis.bar(np.arange(len(errors)) + place * width, errors, width, label=kind)
        axis.set(yscale="log", title=term, xlabel="joint", xticks=np.arange(len(errors)) + 0.4 - width / 2)
        axis.set_xticklabels([str(j) for j in range(len(errors))])
    axes[0].set_ylabel("normalised mean squared error")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=5, fontsize=8)
    figure.savefig(path, dpi=110)
    pyplot.close(figure)
