"""What drives put into a column beside the links' torque: friction, and back electromotive force."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lagnet.diagnosis.effort_column.finding import EffortLimits
from lagnet.diagnosis.effort_column.hypotheses import HypothesisFits
from lagnet.diagnosis.effort_column.samples import FAST

FULL_SCALES = (1.0, 100.0, 255.0, 885.0, 1000.0, 1023.0)  # of duty cycles: fraction, percent, counts
MOST_UNUSED = 12.0  # full scale over the largest number, beyond which it is not that scale


def friction_share(fits: HypothesisFits) -> tuple[float, float]:
    """Least and most of dry friction, and of viscous friction at fast speed, over the torques of all joints."""
    least = most = total = 0.0
    for j in fits.alive:
        found = fits.of(j, "torque")
        fast = float(np.percentile(np.abs(fits.samples.v[:, j]), FAST))
        (dry, s_dry), (wet, s_wet) = found.of("coulomb"), found.of("viscous")
        if not np.isfinite(s_dry + s_wet):
            continue
        least += max(dry - 2 * s_dry, 0.0) + max(wet - 2 * s_wet, 0.0) * fast
        most += max(dry, 0.0) + 2 * s_dry + max(wet, 0.0) * fast
        total += float(np.percentile(np.abs(fits.samples.y[:, j]), FAST))
    return least / max(total, 1e-300), most / max(total, 1e-300)


def back_emf(fits: HypothesisFits, joints: Sequence[int], limits: EffortLimits) -> tuple[float, bool]:
    """Share of the column at fast speed that grows with speed (median of joints), and whether a duty cycle that ends
    at a usual full scale would give a no-load speed near the joints' speed limits.

    Args:
        joints: whose factor between column and model is significant.
    """
    samples, judged = fits.samples, list(joints)
    y, v = np.abs(samples.y), np.abs(samples.v)
    factors = np.array([fits.of(j, "torque").of("viscous")[0] for j in judged])
    fast, size = (np.percentile(x[:, judged], FAST, axis=0) for x in (v, y))
    top, limit = float(y[:, fits.alive].max()), samples.speed_limit[judged]
    share = float(np.median(np.maximum(factors, 0.0) * fast / np.maximum(size, 1e-300)))
    low, high = limits.no_load
    for full in FULL_SCALES:
        if full / MOST_UNUSED <= top <= 1.001 * full:
            no_load = full / np.maximum(factors, 1e-300)
            known = np.where(np.isfinite(limit), limit, fast)
            if np.mean((no_load > low * known) & (no_load < high * known)) > 0.5:
                return share, True
    return share, False
