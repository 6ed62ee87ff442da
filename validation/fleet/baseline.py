"""A plain baseline: a straight line over time through each parameter, without temperature, load or sisters."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.stats import linregress

from lagnet.tracking.track import Track
from validation.fleet.scoring import CHANGED, joint_of

LEVEL = 1e-4
DAY = 86400.0


def told_by_slopes(truth: Sequence[dict[str, Any]], result: Track) -> dict[str, float]:
    """Shares found and wrongly told where a slope over time differs from zero."""
    series: dict[Any, list[Any]] = defaultdict(list)
    for row in result.rows:
        if row.parameter is not None:
            series[row.robot, row.joint, row.effect, row.parameter].append(row)
    told = set()
    for (robot, joint, *_), rows in series.items():
        days = np.array([(r.date - rows[0].date).total_seconds() / DAY for r in rows])
        value = np.array([r.value for r in rows])
        if len(rows) > 2 and np.ptp(value) > 0 and linregress(days, value).pvalue < LEVEL:
            told.add((robot, joint))
    changed = [r for r in truth if r["fate"]["kind"] in CHANGED]
    others = [r for r in truth if r["fate"]["kind"] not in CHANGED]
    return {
        "found": sum((r["name"], joint_of(r)) in told for r in changed) / len(changed),
        "wrong_robots": sum(any(robot == r["name"] for robot, _ in told) for r in others) / len(others),
    }
