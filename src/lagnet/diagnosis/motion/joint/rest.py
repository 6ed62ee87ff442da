"""|u − q − δ − g/kp| ≤ f + κ |g|, an inequality for every sample of a joint at rest: its friction band.

A joint at rest lies anywhere inside its friction band: it gives bounds and no equations. Divided by kp the bounds
are linear in (δ, 1/kp, f, κ): the narrowest band that holds all but a share of the samples is a linear programme. Where
loads do not differ nothing sets 1/kp: then the band is that of the error alone. Source: Koenker & Bassett 1978 (the
linear programme of a quantile).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linprog

from lagnet.recordings.sampling import median_step
from lagnet.rollout.one_joint import JointSeries

STILL = 3.0  # greatest movement of a joint at rest within `SPAN`, in resolutions
SPAN = 0.3  # [s]
MOST = 800  # samples given to the linear programme
OUTSIDE = 0.02  # share of samples that may lie outside the band
LOADED = 0.05  # range of loads over their size below which 1/kp is not determined


@dataclass(frozen=True)
class RestBand:
    """The narrowest friction band that holds a joint's rest positions.

    Args:
        n_samples: samples at rest.
        bias: centre of the band [rad].
        compliance: 1/kp, error per load [rad/(N m)], None where the loads do not differ.
        half_width: f, half-width of the band without load [rad].
        per_load: growth of the half-width with the load [rad/(N m)].
    """

    n_samples: int
    bias: float
    compliance: float | None
    half_width: float
    per_load: float


def at_rest(series: JointSeries, resolution: float) -> np.ndarray:
    """Samples around which the joint does not move and its command does not change, shape (n,)."""
    span = max(2, round(SPAN / median_step(series.time)))
    still = np.ones(len(series.q), dtype=bool)
    for signal, most in ((series.q, STILL * resolution), (series.command, 1e-9 + 0.5 * resolution)):
        for shift in (span // 2, span):
            still[shift:] &= np.abs(signal[shift:] - signal[:-shift]) <= most
    still[:span] = False
    return still & (series.enabled > 0.5)


def rest_band(series: JointSeries, resolution: float) -> RestBand | None:
    """The band of one joint, None where it rests too seldom."""
    rows = np.flatnonzero(at_rest(series, resolution))
    if rows.size < 20:
        return None
    rows = rows[np.linspace(0, rows.size - 1, min(MOST, rows.size)).astype(int)]
    error, load = series.command[rows] - series.q[rows], series.load[rows]
    loaded = float(np.ptp(load)) > LOADED * max(float(np.abs(load).max()), 1e-12) and float(np.ptp(load)) > 1e-6
    bias, compliance, half, per_load = _narrowest(error, load, loaded)
    return RestBand(int(rows.size), bias, compliance if loaded else None, half, per_load)


def _narrowest(error: np.ndarray, load: np.ndarray, loaded: bool) -> tuple[float, float, float, float]:
    """(δ, 1/kp, f, κ) of least mean half-width, with a penalty for every sample outside."""
    n, size = len(error), np.abs(load)
    penalty = 1.0 / (OUTSIDE * n)
    cost = np.concatenate([[0.0, 0.0, 1.0, float(size.mean())], np.full(n, penalty)])
    above = np.column_stack([-np.ones(n), -load, -np.ones(n), -size, -np.eye(n)])
    below = np.column_stack([np.ones(n), load, -np.ones(n), -size, -np.eye(n)])
    most = None if loaded else 0.0
    bounds = [(None, None), (0.0, most), (0.0, None), (0.0, most), *[(0.0, None)] * n]
    found = linprog(cost, np.vstack([above, below]), np.concatenate([-error, error]), bounds=bounds, method="highs")
    if found.x is None:
        return float(np.median(error)), 0.0, float(np.ptp(error)) / 2.0, 0.0
    return tuple(float(x) for x in found.x[:4])  # type: ignore[return-value]
