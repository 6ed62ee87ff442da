"""`lagnet replay`: recorded commands or torques through a model in an engine, against what was measured."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from lagnet.cli.robots import HELP, load_models
from lagnet.errors import LagnetError

if TYPE_CHECKING:
    from lagnet.simulators.before_after import BeforeAfter
    from lagnet.simulators.replay import Servo


def command(
    recordings: Annotated[list[Path], typer.Argument(help="Recordings of torques or commands.")],
    robot: Annotated[str, typer.Option(help="A folder written by diagnose: before and after; or URDF, MJCF, name.")],
    engine: Annotated[str, typer.Option(help="mujoco or pybullet.")] = "mujoco",
    out: Annotated[Path, typer.Option(help="Folder to write.")] = Path("replay"),
    hold: Annotated[str | None, typer.Option(help=HELP)] = None,
    columns: Annotated[
        Path | None, typer.Option(help="Mapping file (TOML) for foreign column names and units.")
    ] = None,
    kp: Annotated[str | None, typer.Option(help="Comma-separated gains [N m/rad], for recorded commands.")] = None,
    kd: Annotated[str | None, typer.Option(help="Comma-separated gains [N m s/rad], for recorded commands.")] = None,
    tolerance: Annotated[float, typer.Option(help="Error at which a rollout has left the recording [rad].")] = 0.05,
    longest: Annotated[float, typer.Option(help="Replay so much of each recording [s].")] = 30.0,
) -> None:
    """Run recordings through a model in an engine, before and after correction."""
    if tolerance <= 0 or longest <= 0:
        raise LagnetError("the tolerance and the length to replay are above zero", where="--tolerance, --longest")
    from lagnet.cli.console import say
    from lagnet.recordings.loading.load import load_recording
    from lagnet.reports.replay_report import write_replay_report
    from lagnet.simulators.before_after import before_and_after, write_replay
    from lagnet.simulators.replay import ReplaySettings

    (model,) = load_models([robot], hold)
    read = [load_recording(p, robot=model, columns=columns) for p in recordings]
    settings = ReplaySettings(engine=engine, tolerance=tolerance, longest=longest, servo=servo_of(kp, kd))
    result = before_and_after(model, read, settings)
    summary, table = write_replay(result, out)
    page = write_replay_report(summary, table, out / "report.html")
    say_replay(result)
    say(f"report: {page}")


def say_replay(result: BeforeAfter) -> None:
    """Errors by joint and horizons, a line each."""
    from lagnet.cli.console import say

    before, after = result.before, result.after
    for i, joint in enumerate(result.joints):
        mended = "" if after is None else f" before, {after.rmse()[i]:.3g} after"
        say(f"{joint}: error {before.rmse()[i]:.3g} {result.units[i]}{mended}")
    if before.horizon is None:
        return
    drive = "commands" if before.runs[0].commanded else "torques"
    unit = " or ".join(sorted(set(result.units), reverse=True))
    mended = "" if after is None or after.horizon is None else f" before, {after.horizon.median:.2f} s after"
    within = f"{before.settings.tolerance:g} {unit}"
    say(f"{drive} alone stay within {within} for {before.horizon.median:.2f} s{mended} (median)")


def servo_of(kp: str | None, kd: str | None) -> Servo | None:
    """Gains of a position controller, or None where none are given.

    Raises:
        LagnetError: only one of the two.
    """
    from lagnet.cli.console import numbers
    from lagnet.simulators.replay import Servo

    if (kp is None) != (kd is None):
        raise LagnetError("a servo has both gains", where="--kp, --kd", next_step="give both, comma-separated")
    if kp is None or kd is None:
        return None
    return Servo(tuple(numbers(kp, "--kp")), tuple(numbers(kd, "--kd")))
