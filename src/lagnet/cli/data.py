"""`lagnet data list | fetch NAME`."""

from __future__ import annotations

import sys
from pathlib import Path

import typer

from lagnet.cli.main import COMMANDS
from lagnet.recordings.datasets import data_sets, fetch
from lagnet.recordings.derived import RECIPES

app = typer.Typer(help=COMMANDS["data"], no_args_is_help=True, add_completion=False, rich_markup_mode="markdown")


@app.command("list")
def list_data_sets() -> None:
    """Print every data set with its files, origin and checksums."""
    for name, data in data_sets().items():
        print(f"{name}: {data.about}")
        print(f"  from {data.repository} at {data.commit}")
        for file in data.files:
            made = "derived from the raw files" if file.name in RECIPES.get(name, {}) else "local copy only"
            origin = file.upstream or f"{made} (LAGNET_DATA_DIR)"
            print(f"  {file.name:40} sha256 {file.sha256 or 'not published'}  {origin}")


@app.command("fetch")
def fetch_data_set(
    name: str = typer.Argument(help="Name of a data set, see `lagnet data list`."),
    out: Path | None = typer.Option(None, help="Folder to put NAME in; the user's cache where not given."),
) -> None:
    """Bring a data set here, checked by sha256: local copies in LAGNET_DATA_DIR first, then its public address."""
    fetched = fetch(name, out, progress=_show if sys.stderr.isatty() else None)
    for path in fetched.paths.values():
        print(path)
    for note in fetched.notes:
        print(f"note: {note}", file=sys.stderr)


def _show(name: str, done: int, expected: int | None) -> None:
    share = f" {done / expected:4.0%}" if expected else ""
    end = "\n" if done == expected else ""
    print(f"\r{name}: {done / 1e6:.1f} MB{share}", end=end, file=sys.stderr, flush=True)
