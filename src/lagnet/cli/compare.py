"""`lagnet compare`: several parameter sets of one robot against recordings."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from lagnet.cli.shared.options import Columns, Hold, TorqueConstant
from lagnet.cli.shared.robots import load_models
from lagnet.errors import LagnetError


def command(
    recordings: Annotated[list[Path], typer.Argument(help="Recordings with torque, or of commands alone.")],
    robot: Annotated[list[str], typer.Option(help="A parameter set: URDF, MJCF, name or folder; repeatable.")],
    hold: Hold = None,
    columns: Columns = None,
    torque_constant: TorqueConstant = None,
    actuator: Annotated[
        list[Path] | None,
        typer.Option(help="Servos (TOML) where commands alone were recorded: one for all sets, or one for each."),
    ] = None,
    gains: Annotated[
        str | None,
        typer.Option(help="Commands alone: comma-separated gains of the recordings over the servos'."),
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder to write.")] = Path("comparison"),
    seed: Annotated[int, typer.Option(help="Seed of the intervals.")] = 0,
) -> None:
    """Say which of several parameter sets explains recordings better, joint by joint.

    Recordings of torque are compared by torque, recordings of commands alone by motion: then a set is a robot with its
    servos, those of an MJCF's position actuators or of --actuator.
    """
    from lagnet.cli.parts.motion import refuse_servo_options, route_of
    from lagnet.cli.shared.console import numbers, say
    from lagnet.cli.shared.reading import while_reading
    from lagnet.comparison.compare import compare
    from lagnet.comparison.motion import compare_motion
    from lagnet.comparison.writing import lines, write_comparison
    from lagnet.recordings.loading.load import load_recording
    from lagnet.recordings.loading.opening import recordings_in

    constants = numbers(torque_constant, "--torque-constant") if torque_constant else None
    models = load_models(robot, hold)
    read = [
        load_recording(p, robot=models[0], columns=columns, torque_constant=constants, progress=while_reading())
        for given in recordings
        for p in recordings_in(given)
    ]
    if route_of(None, read) == "motion":
        factors = numbers(gains, "--gains") if gains else None
        result = compare_motion(*_sets(models, robot, actuator or []), read, seed, factors)
    else:
        refuse_servo_options(actuator, gains)
        result = compare(models, robot, read, seed)
    for line in lines(result):
        say(line)
    say(f"written: {write_comparison(result, out)}")


def _sets(models: list[Any], robot: list[str], files: list[Path]) -> tuple[list[Any], list[str]]:
    """Sets of robots and servos with their names: one of either stands for all, else they go in pairs."""
    from lagnet.comparison.motion import servo_driven
    from lagnet.servos.servo_file import read_servo_file

    if not files:
        return [servo_driven(m, n) for m, n in zip(models, robot, strict=True)], robot
    count = max(len(models), len(files))
    if not {len(models), len(files)} <= {1, count}:
        what = f"{len(models)} robots and {len(files)} files of servos do not pair"
        raise LagnetError(what, where="--actuator", next_step="give one for all, or one for each robot")
    pairs = [(models[i % len(models)], robot[i % len(models)], files[i % len(files)]) for i in range(count)]
    names = robot if len(files) == 1 else [str(f) if len(robot) == 1 else f"{r} with {f}" for _, r, f in pairs]
    servos = [read_servo_file(f, m.joints, m.armature) for m, _, f in pairs]
    return [servo_driven(m, n, s) for (m, n, _), s in zip(pairs, servos, strict=True)], names
