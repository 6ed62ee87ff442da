"""`lagnet data list | fetch NAME | inspect FILE`."""

from __future__ import annotations

import sys
from pathlib import Path

import typer

from lagnet.cli.main import COMMANDS
from lagnet.recordings.datasets.derived import RECIPES
from lagnet.recordings.datasets.fetch import data_sets, fetch

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


@app.command("inspect")
def inspect_log(
    file: Path = typer.Argument(help="Recording, ROS bag, or folder of a LeRobot data set or a motion."),
    robot: str | None = typer.Option(None, help="URDF or MJCF, a name such as ur5, or a folder of train or diagnose."),
    columns: Path | None = typer.Option(None, help="Mapping file (TOML) to read it by."),
    out: Path | None = typer.Option(None, help="Mapping file to write; else FILE's name with .columns.toml."),
) -> None:
    """Say what a log holds, what its effort column most likely is, and write the mapping file to edit."""
    from lagnet.cli.parts.inspection import inspect_file
    from lagnet.cli.shared.console import say
    from lagnet.cli.shared.reading import while_reading
    from lagnet.files import write_whole

    lines, text = inspect_file(file, robot, columns, while_reading())
    for line in lines:
        say(line)
    path = out or Path(f"{file.name or 'log'}.columns.toml")
    write_whole(path, text)
    say(f"mapping file to edit: {path}")


def _show(name: str, done: int, expected: int | None) -> None:
    share = f" {done / expected:4.0%}" if expected else ""
    end = "\n" if done == expected else ""
    print(f"\r{name}: {done / 1e6:.1f} MB{share}", end=end, file=sys.stderr, flush=True)
