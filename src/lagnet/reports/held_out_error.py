"""How far the held-out torque error falls, in a sentence: medians over joints, and always the worst joint by name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import median
from typing import Any

from lagnet.reports.contents.findings import Findings
from lagnet.reports.sections.fit import layers_of
from lagnet.reports.wording import percent

NOISE = 0.5  # of a joint's error that is noise, from which that is said beside it


def error_falls(findings: Findings) -> str:
    """From the nominal model to the named physics, and on to all layers; empty where no layer changes anything.

    Medians are over the joints that differ, the worst joint is that of the whole arm. All figures are those of `fit` in
    the verdict.
    """
    fits = findings.verdict["fit"]
    layers = [key for key, *_ in layers_of(fits)]
    if len(layers) < 2:
        return ""
    shown = [findings.fit(joint) for joint in findings.differing or findings.joints]
    named = "nmse_named" in layers
    steps = [("nmse_named", "")] if named else []
    if layers[-1] != "nmse_named":
        steps.append((layers[-1], " with all layers" if named else " with what is identified and not attributed"))
    start = _size(shown, "nmse_nominal")
    way = "falls" if _size(shown, steps[0][0]) <= start else "changes"
    median_of = "median of the joints that differ" if len(shown) > 1 else ""
    parts, said = [], ""
    for number, (key, words) in enumerate(steps):
        worst = _worst(fits, key)
        beside = "; ".join(filter(None, ["" if number else median_of, "" if worst == said else worst]))
        parts.append(f"to {percent(_size(shown, key))}{words}" + (f" ({beside})" if beside else ""))
        said = worst
    return f"Held-out torque error {way} from {percent(start)} {' and '.join(parts)}."


def _size(shown: Sequence[Mapping[str, Any]], key: str) -> float:
    return median(fit[key] for fit in shown)


def _worst(fits: Sequence[Mapping[str, Any]], key: str) -> str:
    """The joint of the whole arm with the largest error, and its noise floor where that is much of it."""
    if len(fits) < 2:
        return ""
    worst = max(fits, key=lambda fit: fit[key])
    noise = worst["nmse_noise_floor"]
    of_noise = f", noise alone {percent(noise)}" if noise > NOISE * worst[key] else ""
    return f"worst: {worst['joint']}, {percent(worst[key])}{of_noise}"
