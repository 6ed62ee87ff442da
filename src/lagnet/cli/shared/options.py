"""Options that several commands take, each with its help said once."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from lagnet.cli.shared.robots import HELP

Hold = Annotated[str | None, typer.Option(help=HELP)]
Columns = Annotated[Path | None, typer.Option(help="Mapping file (TOML) for foreign column names and units.")]
TorqueConstant = Annotated[str | None, typer.Option(help="Comma-separated [N m/A], where motor current was recorded.")]
ServoKp = Annotated[str | None, typer.Option(help="Comma-separated gains [N m/rad], for recorded commands.")]
ServoGains = Annotated[
    str | None,
    typer.Option(help="After a diagnosis on motion: comma-separated gains of the recordings over the servos'."),
]
ServoKd = Annotated[str | None, typer.Option(help="Comma-separated gains [N m s/rad], for recorded commands.")]
