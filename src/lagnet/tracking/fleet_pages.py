"""What a track found, as the report's page takes it."""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from lagnet.reports.contents.fleet import Fleet, FleetEvent, FleetNotFollowed, FleetRobot, FleetSeries
from lagnet.tracking.statistics.analyse import Standing
from lagnet.tracking.tables import TrackRow
from lagnet.tracking.track import Track

PAGE, VERDICT = "report.html", "verdict.json"


def fleet_of(track: Track) -> Fleet:
    """The fleet with its changes; points lead to the report of their diagnosis, or to its verdict."""
    page = PAGE if track.manifest.settings.reports else VERDICT
    rows: dict[str, list[TrackRow]] = defaultdict(list)
    for row in track.rows:
        rows[row.robot].append(row)
    standings = {(s.robot, s.joint, s.effect, s.parameter): s for s in track.analysis.standings}
    events = [FleetEvent(**{n: getattr(e, n) for n in FleetEvent.__dataclass_fields__}) for e in track.analysis.events]
    robots = [_robot(name, track.joints.get(name, ()), rows[name], page, standings) for name in sorted(rows)]
    names = FleetNotFollowed.__dataclass_fields__
    left_out = [FleetNotFollowed(**{n: getattr(one, n) for n in names}) for one in track.not_followed]
    return Fleet(robots, events, left_out)


def _robot(
    name: str, joints: tuple[str, ...], rows: list[TrackRow], page: str, standings: dict[tuple, Standing]
) -> FleetRobot:
    first = {r.recording: r for r in reversed(rows)}
    recordings = sorted(first, key=lambda r: (first[r].date, r))
    index_of = {r: i for i, r in enumerate(recordings)}
    warm: dict[str, list[float]] = defaultdict(list)
    groups: dict[tuple, list[TrackRow]] = defaultdict(list)
    for row in rows:
        if row.temperature is not None:
            warm[row.recording].append(row.temperature)
        if row.parameter is not None:
            groups[row.joint, row.effect, row.parameter].append(row)
    series = tuple(_series(found, index_of, standings.get((name, *key))) for key, found in groups.items())
    return FleetRobot(
        name,
        rows[0].make,
        joints,
        tuple(first[r].date for r in recordings),
        tuple(recordings),
        tuple(f"{first[r].diagnosis}/{page}" if first[r].diagnosis else None for r in recordings),
        tuple(first[r].error for r in recordings),
        np.array([np.mean(warm[r]) if warm[r] else np.nan for r in recordings]),
        series,
    )


def _series(rows: list[TrackRow], index_of: dict[str, int], standing: Standing | None) -> FleetSeries:
    rows = sorted(rows, key=lambda r: index_of[r.recording])
    one = rows[0]
    value, lower, upper, adjusted = (
        np.array([np.nan if getattr(r, n) is None else getattr(r, n) for r in rows], dtype=float)
        for n in ("value", "lower", "upper", "adjusted")
    )
    family = None
    if standing is not None and standing.family_lower is not None and standing.family_upper is not None:
        family = (standing.family_lower, standing.family_upper)
    return FleetSeries(
        one.joint,
        str(one.effect),
        str(one.parameter),
        str(one.unit),
        np.array([index_of[r.recording] for r in rows]),
        value,
        lower,
        upper,
        adjusted,
        family,
        bool(standing and standing.out_of_family),
        standing.by_temperature if standing and standing.relative else None,
    )
