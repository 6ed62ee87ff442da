"""`lagnet diagnose`: recordings against a model, to a folder with verdict, report and corrected model."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from lagnet.cli.shared.options import Columns, Hold, TorqueConstant
from lagnet.cli.shared.robots import load_models
from lagnet.errors import LagnetError

if TYPE_CHECKING:
    from lagnet.diagnosis.diagnose import Diagnosis


def command(
    recordings: Annotated[
        list[Path], typer.Argument(help="Recordings to fit on (.csv, .csv.gz, .parquet, .npz, .mat).")
    ],
    robot: Annotated[
        str | None,
        typer.Option(help="Nominal model: URDF or MJCF, a name such as ur5, or a folder of train or diagnose."),
    ] = None,
    simulated: Annotated[
        list[Path] | None, typer.Option(help="Recordings of the simulator, where there is no model of it.")
    ] = None,
    holdout: Annotated[
        list[Path] | None, typer.Option(help="Recordings that are not fitted; else the last fifth of each.")
    ] = None,
    hold: Hold = None,
    columns: Columns = None,
    torque_constant: TorqueConstant = None,
    out: Annotated[Path, typer.Option(help="Folder to write.")] = Path("diagnosis"),
    bandwidth: Annotated[
        float | None, typer.Option(help="Low-pass on torques [Hz]; else chosen from the data.")
    ] = None,
    suggest_motion: Annotated[
        bool, typer.Option("--suggest-motion", help="Write a motion to record next, which breaks ties: see docs.")
    ] = False,
    route: Annotated[
        str | None, typer.Option(help="torque or motion; else motion where commands were recorded and no torque.")
    ] = None,
    actuator: Annotated[
        Path | None, typer.Option(help="Nominal servos (TOML) of the motion route; else the MJCF's, else estimated.")
    ] = None,
    gains: Annotated[
        str | None,
        typer.Option(
            help="Motion route: comma-separated gains of the recordings, then of --holdout, over the servo's."
        ),
    ] = None,
    mcap: Annotated[
        Path | None, typer.Option(help="Write torques and verdict for Foxglove, PlotJuggler and Rerun to this file.")
    ] = None,
    replay: Annotated[
        str | None,
        typer.Option(help="mujoco or pybullet: held-out recordings in it, before and after correction, in the report."),
    ] = None,
    kp: Annotated[str | None, typer.Option(help="With --replay of commands: gains [N m/rad], comma-separated.")] = None,
    kd: Annotated[str | None, typer.Option(help="With --replay of commands: gains [N m s/rad].")] = None,
    seed: Annotated[int, typer.Option(help="Seed of everything random.")] = 0,
) -> None:
    """Say where recordings and robot differ, and name the physics that was left out."""
    if bool(simulated) == bool(robot):
        raise LagnetError(
            "give either --robot or --simulated",
            next_step="--robot takes a URDF, MJCF, name or folder; --simulated takes recordings of the simulator",
        )
    if simulated and hold:
        raise LagnetError("--hold holds joints of --robot; a simulator's recordings have those that they have")
    from lagnet.cli.parts.motion import diagnose_on_motion, refuse_servo_options, route_of
    from lagnet.cli.parts.replayed import replay_held_out, replay_settings
    from lagnet.cli.parts.simulated import nominal_from
    from lagnet.cli.shared.console import above_zero, not_negative, numbers, say
    from lagnet.cli.shared.reading import while_reading
    from lagnet.diagnosis.diagnose import diagnose
    from lagnet.diagnosis.nominal.log_alignment import lay_side_by_side
    from lagnet.diagnosis.writing import write_diagnosis
    from lagnet.files import write_together
    from lagnet.recordings.loading.load import load_recording
    from lagnet.recordings.loading.opening import recordings_in
    from lagnet.reports.diagnosis_report import write_report

    above_zero(bandwidth, "--bandwidth")
    not_negative(seed, "--seed")
    constants = numbers(torque_constant, "--torque-constant") if torque_constant else None
    model, missed, of_simulator = (
        (*load_models([robot], hold), None, []) if robot else nominal_from(simulated or [], columns, constants, seed)
    )
    read = [
        [
            load_recording(p, robot=model, columns=columns, torque_constant=constants, progress=while_reading())
            for given in paths
            for p in recordings_in(given)
        ]
        for paths in (recordings, holdout or [])
    ]
    on_motion = bool(robot) and route_of(route, [*read[0], *read[1]]) == "motion"
    simulator = replay_settings(replay, model, kp, kd, on_motion)
    say(f"{sum(map(len, read))} recordings read, diagnosing")
    if on_motion:
        factors = numbers(gains, "--gains") if gains else None
        return diagnose_on_motion(read[0], model, read[1] or None, out, actuator, factors, simulator, seed)
    refuse_servo_options(actuator, gains, "add --route motion, or leave it out")
    result = diagnose(read[0], model, read[1] or None, bandwidth=bandwidth, nominal_error=missed, seed=seed)
    evidence = replace(result.evidence, overlays=lay_side_by_side([*read[0], *read[1]], of_simulator))

    def fill(folder: Path) -> None:
        write_diagnosis(result, folder)
        write_report(result.verdict.to_dict(), evidence, folder / "report.html")

    write_together(out, fill, last="verdict.json")
    if mcap:
        from lagnet.cli.parts.mcap import write_mcap_of

        say(f"MCAP: {write_mcap_of(result, mcap)}")
    if simulator:
        replayed = replay_held_out(result, simulator, out)
        write_report(result.verdict.to_dict(), evidence, out / "report.html", replayed)
    _say_what_differs(result)
    if suggest_motion:
        _suggest(result, out, seed)
    say(f"report: {out / 'report.html'}")


def _say_what_differs(result: Diagnosis) -> None:
    """The named physics, a sentence or two each; links that differ, where the causes were judged beside them."""
    from lagnet.cli.shared.console import say
    from lagnet.diagnosis.verdict.wording import BESIDE_FREE_LINKS

    if BESIDE_FREE_LINKS in result.verdict.warnings:
        say(f"{BESIDE_FREE_LINKS[0].upper()}{BESIDE_FREE_LINKS[1:]}.")
    for effect in result.effects:
        say(effect.explanation)
    if not result.effects:
        say(
            "No left-out physics was found."
            if not result.verdict.found
            else "The mismatch found fits no known physics."
        )


def _suggest(result: Diagnosis, out: Path, seed: int) -> None:
    """Searches the motion to record next and writes it beside the verdict."""
    from lagnet.cli.shared.console import say
    from lagnet.experiment_design.suggest_motion import suggest_motion
    from lagnet.experiment_design.writing import MOTION, words_of, write_suggestion

    say("searching for the motion that settles most of what is open")
    suggested = suggest_motion(result, seed)
    write_suggestion(suggested, out)
    for line in words_of(suggested, str(out / MOTION)):
        say(line)
