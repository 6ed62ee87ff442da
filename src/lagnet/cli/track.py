"""`lagnet track`: the recordings of a fleet, to a table of its physics over time, its changes and a report."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer


def command(
    manifest: Annotated[
        Path, typer.Argument(help="TOML file with makes, robots and dated recordings; see docs/fleet.")
    ],
    out: Annotated[Path, typer.Option(help="Folder to write; what is finished there is not done again.")] = Path(
        "track"
    ),
    scheduler: Annotated[
        str | None,
        typer.Option(help="Address of a Dask scheduler, like tcp://10.0.0.1:8786; else this machine's cores."),
    ] = None,
    workers: Annotated[int | None, typer.Option(min=1, help="Processes of this machine; else one a core.")] = None,
    memory: Annotated[float, typer.Option(min=0.2, help="Memory of each process of this machine [GB].")] = 1.5,
) -> None:
    """Follow the physics of robots over time: what changed, when, and whether temperature and load explain it."""
    from lagnet.cli.shared.console import say
    from lagnet.cli.shared.progress import Bar
    from lagnet.reports.fleet_report import write_fleet_report
    from lagnet.tracking.engine import EngineSettings
    from lagnet.tracking.fleet_pages import fleet_of
    from lagnet.tracking.track import track

    with Bar(sys.stderr) as bar:
        result = track(manifest, out, EngineSettings(scheduler, workers, round(memory * 1e9)), bar.show)
    report = write_fleet_report(fleet_of(result), result.folder / "report.html")
    say(f"{len(result.manifest.recordings)} recordings of {len(result.manifest.robots)} robots")
    for row in result.failed[:10]:
        say(f"not diagnosed: {row.recording}: {row.error}")
    if len(result.failed) > 10:
        say(f"… and {len(result.failed) - 10} more, see the column error of track.parquet")
    changed = sorted({e.robot for e in result.analysis.events})
    say(
        f"{len(changed)} robots changed"
        + (f": {', '.join(changed[:12])}{' …' * (len(changed) > 12)}" if changed else "")
    )
    say(f"report: {report}")
