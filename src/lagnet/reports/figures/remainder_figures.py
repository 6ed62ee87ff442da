"""What stays unexplained at a joint, against the signal that predicts it best."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from lagnet.diagnosis.verdict.report_data import JointEvidence
from lagnet.reports.figures.decimation import scattered
from lagnet.reports.figures.figure import Figure, axis, colour, packed
from lagnet.reports.wording import percent

SHOWN = 1500  # samples of a cloud
QUANTITIES: Mapping[str, tuple[str, str, str]] = {  # of a signal: in words, unit where the joint turns, where it slides
    "q": ("position", "rad", "m"),
    "v": ("velocity", "rad/s", "m/s"),
    "a": ("acceleration", "rad/s²", "m/s²"),
    "load": ("torque foreseen by the nominal model", "N m", "N"),
    "history": ("velocity a moment before", "rad/s", "m/s"),
}


def remainder_by_signal(key: str, joint: JointEvidence, sliding: frozenset[int]) -> Figure | None:
    """A cloud of the residual with its median.

    Args:
        key: place in the page.
        joint: evidence of the joint.
        sliding: numbers of the prismatic joints.
    """
    shape = joint.remainder
    if shape is None or len(shape.value) == 0:
        return None
    words, unit = _quantity(shape.signal, sliding)
    chosen = scattered(len(shape.value), SHOWN)
    cloud = {
        "type": "scatter", "mode": "markers", "name": "left after the named physics",
        "x": packed(np.asarray(shape.value)[chosen]), "y": packed(np.asarray(shape.residual)[chosen]),
        "marker": {"color": colour("corrected"), "size": 3.5, "opacity": 0.45},
        "hovertemplate": "%{x:.3g}<br>%{y:.4g}<extra></extra>",
    }  # fmt: skip
    median = {
        "type": "scatter", "mode": "lines", "name": "median", "x": packed(shape.curve[:, 0]),
        "y": packed(shape.curve[:, 1]), "line": {"color": colour("law"), "width": 3},
        "hovertemplate": "%{x:.3g}<br>median %{y:.4g}<extra></extra>",
    }  # fmt: skip
    torque = "force" if joint.unit == "N" else "torque"
    layout = {
        "xaxis": axis(f"{words} ({shape.signal})", unit),
        "yaxis": axis(f"{torque} left", joint.unit),
        "margin": {"t": 40},
        "hovermode": "closest",
    }
    return Figure(key, [cloud, median], f"What stays unexplained at {joint.joint} against {shape.signal}", layout, 280)


def formula_words(joint: JointEvidence) -> str | None:
    """The formula with what it is worth; None where no simple one holds."""
    shape = joint.remainder
    if shape is None or shape.formula is None:
        return None
    return f"{shape.formula} [{joint.unit}] predicts {percent(shape.share)} of it on held-out motion"


def _quantity(signal: str, sliding: frozenset[int]) -> tuple[str, str]:
    kind, _, number = signal.partition("_")
    if kind not in QUANTITIES:
        return "time", "s"
    words, turning, slides = QUANTITIES[kind]
    return f"{words} of joint {number}", slides if int(number) in sliding else turning
