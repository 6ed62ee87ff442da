"""Fleets of any size for pages: parameters that wander, a few robots that change."""

from __future__ import annotations

from datetime import datetime, timedelta

import numpy as np

from lagnet.reports.contents.fleet import Fleet, FleetEvent, FleetRobot, FleetSeries

START = datetime(2026, 1, 5)
JOINTS = ("waist", "shoulder", "elbow")


def synthetic_fleet(n_robots: int, n_recordings: int, seed: int = 0, prefix: str = "arm", days: float = 3.0) -> Fleet:
    """Robots of two makes; each tenth changes half-way, each hundredth in the last week."""
    rng = np.random.default_rng(seed)
    robots, events = [], []
    dates = tuple(START + timedelta(days=days * k) for k in range(n_recordings))
    for r in range(n_robots):
        name, since = f"{prefix}_{r:03d}", n_recordings - 1 if r % 100 == 0 else n_recordings // 2
        series = []
        for joint in JOINTS:
            for effect, parameter, unit in (("coulomb_friction", "Fc", "N m"), ("viscous_friction", "Fv", "N m s/rad")):
                value = rng.lognormal(0.0, 0.05) * np.exp(0.01 * rng.standard_normal(n_recordings))
                if r % 10 == 0 and joint == "elbow":
                    value[since:] *= 1.2
                    at = dates[since]
                    size = (0.2, 0.18, 0.22)
                    events.append(
                        FleetEvent(name, joint, effect, parameter, unit, "step", at, at, at, *size, True, True)
                    )
                series.append(
                    FleetSeries(
                        joint,
                        effect,
                        parameter,
                        unit,
                        np.arange(n_recordings),
                        value,
                        0.98 * value,
                        1.02 * value,
                        value,
                        (0.9, 1.1),
                        r % 50 == 7 and joint == "waist",
                        0.1,
                    )
                )
        paths = tuple(f"{name}/{d:%Y-%m-%d}.parquet" for d in dates)
        pages = tuple(
            None if k == 1 and r == 3 else f"diagnoses/{name}/{d:%Y-%m-%d}/report.html" for k, d in enumerate(dates)
        )
        errors = tuple("the file is empty" if p is None else None for p in pages)
        warm = 25.0 + rng.standard_normal(n_recordings)
        robots.append(FleetRobot(name, "AB"[r % 2], JOINTS, dates, paths, pages, errors, warm, tuple(series)))
    return Fleet(robots, sorted(events, key=lambda e: (e.date, e.robot)))
