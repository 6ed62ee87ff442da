"""`lagnet compare`: several parameter sets of one robot against recordings."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from lagnet.cli.shared.robots import HELP, load_models


def command(
    recordings: Annotated[list[Path], typer.Argument(help="Recordings with torque.")],
    robot: Annotated[list[str], typer.Option(help="A parameter set: URDF, MJCF, name or folder; repeatable.")],
    hold: Annotated[str | None, typer.Option(help=HELP)] = None,
    columns: Annotated[
        Path | None, typer.Option(help="Mapping file (TOML) for foreign column names and units.")
    ] = None,
    torque_constant: Annotated[
        str | None, typer.Option(help="Comma-separated [N m/A], where motor current was recorded.")
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder to write.")] = Path("comparison"),
    seed: Annotated[int, typer.Option(help="Seed of the intervals.")] = 0,
) -> None:
    """Say which of several parameter sets explains recordings better, joint by joint."""
    from lagnet.cli.shared.console import numbers, say
    from lagnet.comparison.compare import compare, write_comparison
    from lagnet.recordings.loading.load import load_recording

    constants = numbers(torque_constant, "--torque-constant") if torque_constant else None
    models = load_models(robot, hold)
    read = [load_recording(p, robot=models[0], columns=columns, torque_constant=constants) for p in recordings]
    result = compare(models, robot, read, seed)
    for joint in result.joints:
        others = [
            f"{name} {100 * joint.nmse[m]:.3g} % [{100 * joint.interval[m, 0]:.3g}, {100 * joint.interval[m, 1]:.3g}]"
            for m, name in enumerate(result.names)
        ]
        tied = [result.names[m] for m in joint.also]
        best = result.names[joint.best] + (f", not told from {', '.join(tied)}" if tied else "")
        say(f"{joint.joint}: best {best}; error {'; '.join(others)}")
    if result.parameters is None:
        say(f"parameters are not compared: {result.reason}")
    else:
        found = result.parameters
        say(
            f"the sets differ in {len(found.differing)} base parameters; these recordings resolve {len(found.resolved)}"
        )
        for entry in result.to_record[:5]:
            say(f"to record: {entry.words()}")
    say(f"written: {write_comparison(result, out)}")
