"""`lagnet replay`: recorded commands or torques through a model in an engine, against what was measured."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from lagnet.cli.shared.options import Columns, Hold, ServoGains, ServoKd, ServoKp, TorqueConstant
from lagnet.cli.shared.robots import load_models
from lagnet.errors import LagnetError


def command(
    recordings: Annotated[list[Path], typer.Argument(help="Recordings of torques or commands.")],
    robot: Annotated[str, typer.Option(help="A folder written by diagnose: before and after; or URDF, MJCF, name.")],
    engine: Annotated[str, typer.Option(help="mujoco or pybullet.")] = "mujoco",
    out: Annotated[Path, typer.Option(help="Folder to write.")] = Path("replay"),
    hold: Hold = None,
    columns: Columns = None,
    torque_constant: TorqueConstant = None,
    kp: ServoKp = None,
    kd: ServoKd = None,
    gains: ServoGains = None,
    tolerance: Annotated[float, typer.Option(help="Error at which a rollout has left the recording [rad].")] = 0.05,
    longest: Annotated[float, typer.Option(help="Replay so much of each recording [s].")] = 30.0,
) -> None:
    """Run recordings through a model in an engine, before and after correction."""
    if tolerance <= 0 or longest <= 0:
        raise LagnetError("the tolerance and the length to replay are above zero", where="--tolerance, --longest")
    from lagnet.cli.shared.console import numbers, say
    from lagnet.cli.shared.reading import while_reading
    from lagnet.cli.shared.replays import say_replay, servo_of
    from lagnet.recordings.loading.load import load_recording
    from lagnet.reports.replay_report import write_replay_report
    from lagnet.simulators.before_after import before_and_after, write_replay
    from lagnet.simulators.replay import ReplaySettings

    (model,) = load_models([robot], hold)
    constants = numbers(torque_constant, "--torque-constant") if torque_constant else None
    read = [
        load_recording(p, robot=model, columns=columns, torque_constant=constants, progress=while_reading())
        for p in recordings
    ]
    servo = {"servo": servo_of(kp, kd), "gains": tuple(numbers(gains, "--gains")) if gains else ()}
    settings = ReplaySettings(engine=engine, tolerance=tolerance, longest=longest, **servo)
    result = before_and_after(model, read, settings)
    summary, table = write_replay(result, out)
    page = write_replay_report(summary, table, out / "report.html")
    say_replay(result)
    say(f"report: {page}")
