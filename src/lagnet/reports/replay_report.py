"""The report of a replay: the user's simulator before and after, from the two files that a replay writes."""

from __future__ import annotations

import json
from pathlib import Path

import pyarrow.parquet as pq

from lagnet.reports.contents.replay_data import ReplayData
from lagnet.reports.page import write_page
from lagnet.reports.sections import your_simulator
from lagnet.reports.wording import counted


def read_replay(summary: str | Path, table: str | Path) -> ReplayData:
    """What `replay.json` and `replay.parquet` hold."""
    text = json.loads(Path(summary).read_text(encoding="utf-8"))
    columns = pq.read_table(table).to_pydict()
    return ReplayData(text, columns)


def write_replay_report(summary: str | Path, table: str | Path, path: str | Path) -> Path:
    """Write the page.

    Args:
        summary: `replay.json`.
        table: `replay.parquet`.
        path: the file to write; replaced in one step.

    Returns:
        The file that was written.
    """
    data = read_replay(summary, table)
    seconds = sum(r["seconds"] for r in data.summary["recordings"])
    stretches = counted(len(data.summary["recordings"]), "stretch", "stretches")
    subtitle = f"{data.summary['engine']}, {stretches} of recordings, {seconds:.0f} s"
    return write_page(path, "Your simulator against recordings", subtitle, [your_simulator.build(data)])
