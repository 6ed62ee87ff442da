"""`lagnet decompose`: split a model's torque along recordings, to a folder with table, summary and report."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from lagnet.cli.shared.options import Columns, Hold, TorqueConstant
from lagnet.cli.shared.robots import load_models
from lagnet.percent import percent


def command(
    model: Annotated[
        str, typer.Argument(help="A folder written by train or diagnose, a URDF or MJCF, or a name such as ur5.")
    ],
    recordings: Annotated[list[Path], typer.Argument(help="Recordings (.csv, .csv.gz, .parquet, .npz, .mat).")],
    reference: Annotated[
        str | None, typer.Option(help="A model that is believed, compared term by term; same forms as MODEL.")
    ] = None,
    member: Annotated[
        list[str] | None, typer.Option(help="Further model of an ensemble, whose spread becomes a band; repeatable.")
    ] = None,
    hold: Hold = None,
    columns: Columns = None,
    torque_constant: TorqueConstant = None,
    out: Annotated[Path, typer.Option(help="Folder to write.")] = Path("decomposition"),
    seed: Annotated[int, typer.Option(help="Seed of the intervals.")] = 0,
) -> None:
    """Split the torque into inertial, Coriolis, gravity and residual parts."""
    from lagnet.cli.shared.console import say
    from lagnet.cli.shared.reading import while_reading
    from lagnet.decomposition.decompose import decompose
    from lagnet.decomposition.writing import write_decomposition
    from lagnet.recordings.loading.load import load_recording
    from lagnet.reports.decomposition_report import write_decomposition_report

    constants = [float(x) for x in torque_constant.split(",")] if torque_constant else None
    specs = [model, *(member or [])]
    loaded = load_models([*specs, reference] if reference else specs, hold)
    models, believed = loaded[: len(specs)], loaded[-1] if reference else None
    read = [
        load_recording(p, robot=models[0], columns=columns, torque_constant=constants, progress=while_reading())
        for p in recordings
    ]
    parts = decompose(models if member else models[0], read, believed, seed=seed)
    write_decomposition(parts, out)
    page = write_decomposition_report(parts, model, reference, out / "report.html")
    for joint, error, share in zip(parts.joints, parts.total_error.nmse, parts.shares["residual"], strict=True):
        say(f"{joint}: nMSE of the total torque {error:.3g}, share of the residual {percent(share, 3)}")
    say(f"report: {page}")
