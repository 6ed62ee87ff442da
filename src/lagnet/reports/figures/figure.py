"""What a plot of a report is made of: traces and axes as plain data, drawn by plotly.js in the reader's browser.

Colours are given by role, as `colour("measured")`; the page's style sheet holds one value of each for light and one for
dark screens, and the page's script puts it in. Arrays travel as packed 32-bit floats, a third of their size as text.
"""

from __future__ import annotations

import base64
import html
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

Trace = dict[str, Any]
SAME_X = "same x"  # as `x` of a trace: the x of the trace before it, sent but once


@dataclass(frozen=True)
class Figure:
    """One plot of a page.

    Args:
        key: its place in the page, unique there: letters, digits and dashes.
        traces: plotly.js traces.
        layout: plotly.js layout; fonts, grid and margins come from the page.
        description: what it shows, for those who do not see it.
        height: height on the page, in CSS pixels.
    """

    key: str
    traces: Sequence[Trace]
    description: str
    layout: dict[str, Any] = field(default_factory=dict)
    height: int = 340

    def specification(self) -> dict[str, Any]:
        """What plotly.js draws."""
        return {"data": list(self.traces), "layout": {**self.layout, "height": self.height}}


def colour(role: str) -> str:
    """A colour of the page's style sheet by its role: measured, nominal, corrected, law, noise, accent, good, bad."""
    return f"var(--{role})"


def plain(words: str) -> str:
    """Words for a plot that are shown as they stand: plotly.js would read tags in them."""
    return html.escape(words, quote=False)


def axis(quantity: str, unit: str, **more: Any) -> dict[str, Any]:
    """An axis titled with its quantity and unit; the unit of a pure number is "–"."""
    return {"title": {"text": plain(f"{quantity} [{unit}]")}, **more}


def names_axis(**more: Any) -> dict[str, Any]:
    """An axis of names, such as joints, which have no unit."""
    return {"type": "category", **more}


def packed(values: Any) -> dict[str, str]:
    """Numbers as 32-bit floats in base64, shape (n,); values that are not finite become gaps of a line."""
    array = np.asarray(values, dtype=float).astype("<f4")
    array[~np.isfinite(array)] = np.nan
    return {"dtype": "f4", "bdata": base64.b64encode(np.ascontiguousarray(array).tobytes()).decode("ascii")}
