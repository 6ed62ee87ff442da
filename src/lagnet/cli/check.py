"""`lagnet check`: hold a model or robot against physics; exit code 1 when a check fails."""

from __future__ import annotations

import math
import os
import sys
from pathlib import Path
from typing import Annotated

import typer

from lagnet.cli.shared.options import Columns, Hold
from lagnet.cli.shared.robots import load_models
from lagnet.errors import LagnetError


def command(
    model: Annotated[
        str, typer.Argument(help="URDF or MJCF, a name such as ur5, or a folder written by train or diagnose.")
    ],
    reference: Annotated[
        str | None, typer.Option(help="A model that is believed, compared term by term; same forms as MODEL.")
    ] = None,
    recording: Annotated[
        list[Path] | None, typer.Option(help="What the robot did: sets the range of motion, and is held to the limits.")
    ] = None,
    hold: Hold = None,
    columns: Columns = None,
    vertical_base: Annotated[
        bool, typer.Option("--vertical-base", help="The first axis is vertical: check that its angle does not matter.")
    ] = False,
    limit: Annotated[
        list[str] | None, typer.Option(help="Limit of your own, as NAME=VALUE in the unit of the check; repeatable.")
    ] = None,
    skip: Annotated[list[str] | None, typer.Option(help="Name of a check to leave out; repeatable.")] = None,
    out: Annotated[Path | None, typer.Option(help="Folder for plausibility.json and report.html.")] = None,
    seed: Annotated[int, typer.Option(help="Seed of everything random.")] = 0,
) -> None:
    """Hold a model or robot against physics; exit code 1 when a check fails."""
    from lagnet.cli.shared.console import not_negative
    from lagnet.plausibility.settings import CheckSettings
    from lagnet.plausibility.suite import check
    from lagnet.recordings.loading.load import load_recording

    not_negative(seed, "--seed")
    settings = CheckSettings(limits=_limits(limit or []), skip=tuple(skip or ()), vertical_base=vertical_base)
    loaded, *rest = load_models([model, reference] if reference else [model], hold)
    believed = rest[0] if rest else None
    # Degrees passed as radians are what the checks are asked to find: the reader must not refuse them here.
    recordings = [load_recording(path, joints=loaded.joints, columns=columns) for path in recording or []]
    report = check(loaded, believed, recordings, seed=seed, settings=settings)
    lines = [report.headline(), *(f"  {result.status:<14} {result.sentence()}" for result in report.checks)]
    if out is not None:
        from lagnet.reports.plausibility_report import write_plausibility_report

        out.mkdir(parents=True, exist_ok=True)
        report.write(out / "plausibility.json")
        page = write_plausibility_report(report, model, out / "report.html")
        lines.append(f"report: {page}")
    _tell(lines)
    if not report.passed:
        raise typer.Exit(1)


def _tell(lines: list[str]) -> None:
    """Print, also to a reader who closes the pipe behind the first line: the exit code stays that of the checks."""
    try:
        print("\n".join(lines), flush=True)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _limits(words: list[str]) -> dict[str, float]:
    """Limits by name of check.

    Raises:
        LagnetError: a word is not NAME=VALUE.
    """
    limits = {}
    for word in words:
        name, _, value = word.partition("=")
        try:
            limits[name.strip()] = float(value)
            if math.isnan(limits[name.strip()]):
                raise ValueError
        except ValueError:
            raise LagnetError(
                f"{word!r} is no limit", where="--limit", next_step="write NAME=VALUE, e.g. gravity_is_gradient=1e-4"
            ) from None
    return limits
