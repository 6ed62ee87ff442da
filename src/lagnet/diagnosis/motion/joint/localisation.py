"""E[e² | regime] / E[e²]: in which regimes of speed, direction, load, pose and command steps an error is large."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from lagnet.recordings.sampling import median_step

LIFT = 1.25  # least error power inside a regime over that overall to be reported
LEAST = 0.01  # least share of time of a regime


def regimes(signals: Mapping[str, np.ndarray], joint: int) -> dict[str, tuple[str, np.ndarray]]:
    """Name → (readable rule, mask (n,)) of every regime of one joint.

    Args:
        signals: `q`, `v`, `load`, `command`, `time` of the joint, each of shape (n,).
        joint: its index, for the rules.
    """
    q, v, load, command = signals["q"], signals["v"], signals["load"], signals["command"]
    step = np.abs(np.diff(command, prepend=command[0]))
    fast, slow = float(np.quantile(np.abs(v), 0.9)), max(0.05 * float(np.abs(v).max()), 1e-6)
    jump = max(4.0 * float(np.median(step[step > 0.0])) if (step > 0.0).any() else 0.0, 1e-6)
    heavy, high, low = float(np.quantile(np.abs(load), 0.8)), *(float(np.quantile(q, x)) for x in (0.8, 0.2))
    turned = np.convolve(np.sign(v[1:]) * np.sign(v[:-1]) < 0.0, np.ones(9), "same") > 0.0
    return {
        "low_speed": (f"|v_{joint}| < {slow:.3g} rad/s", np.abs(v) < slow),
        "high_speed": (f"|v_{joint}| > {fast:.3g} rad/s", np.abs(v) > fast),
        "velocity_reversal": (f"v_{joint} changes sign", np.append(turned, False)),
        "positive_direction": (f"v_{joint} > {slow:.3g} rad/s", v > slow),
        "negative_direction": (f"v_{joint} < -{slow:.3g} rad/s", v < -slow),
        "high_load": (f"|load_{joint}| > {heavy:.3g} N m", np.abs(load) > heavy),
        "position": (f"q_{joint} > {high:.3g} rad", q > high),
        "low_position": (f"q_{joint} < {low:.3g} rad", q < low),
        "command_step": (f"command_{joint} has jumped by {jump:.3g} rad", _after(step > jump, signals["time"])),
    }


def _after(event: np.ndarray, time: np.ndarray, span: float = 0.3) -> np.ndarray:
    """Samples within `span` seconds after an event."""
    count = max(1, round(span / max(median_step(time), 1e-9)))
    return np.convolve(event, np.ones(count))[: event.size] > 0.0


def locate_error(error: np.ndarray, signals: Mapping[str, np.ndarray], joint: int) -> tuple[dict[str, Any], ...]:
    """Regimes in which the error is larger than elsewhere, strongest first; `everywhere` where none stands out."""
    power = error**2
    total, out = float(power.mean()) + 1e-300, []
    for name, (rule, mask) in regimes(signals, joint).items():
        share = float(mask.mean())
        if share < LEAST:
            continue
        lift = float(power[mask].mean()) / total
        if lift > LIFT:
            out.append({"regime": name, "rule": rule, "share_of_residual": min(1.0, lift * share)})
            out[-1] |= {"share_of_time": share, "lift": lift}
    out.sort(key=lambda entry: -entry["lift"])
    everywhere = {"regime": "everywhere", "rule": "always", "share_of_residual": 1.0, "share_of_time": 1.0, "lift": 1.0}
    return tuple(out) or (everywhere,)


def predictors(
    error: np.ndarray, signals: Mapping[str, np.ndarray], joint: int, least: float = 0.05
) -> tuple[str, ...]:
    """Signals that predict the error, strongest first: those with a share of its variance between ten of their bins."""
    variance, found = float(np.mean(error**2)) + 1e-300, []
    for name, label in (("q", "q"), ("v", "v"), ("load", "load"), ("command", "command"), ("time", "time")):
        edges = np.unique(np.quantile(signals[name], np.linspace(0.1, 0.9, 9)))
        index = np.searchsorted(edges, signals[name])
        counts, sums = np.bincount(index), np.bincount(index, weights=error)
        share = float(np.sum(sums**2 / np.maximum(counts, 1)) / len(error)) / variance
        if share > least:
            found.append((share, label if name == "time" else f"{label}_{joint}"))
    return tuple(name for _, name in sorted(found, reverse=True))
