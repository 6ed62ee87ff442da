"""The motion route of `lagnet diagnose`: recordings of commands and positions, to a folder of the same kind."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lagnet.errors import LagnetError
from lagnet.recordings.recording import Recording

if TYPE_CHECKING:
    from lagnet.simulators.replay import ReplaySettings

ROUTES = ("torque", "motion")


def check_route(asked: str) -> None:
    """Holds a route against those that there are.

    Raises:
        LagnetError: no such route.
    """
    if asked not in ROUTES:
        raise LagnetError(f"unknown route {asked!r}", choices=ROUTES)


def route_of(asked: str | None, recordings: Sequence[Recording]) -> str:
    """The route that was asked for; else motion where no recording holds torque or current, but all hold commands.

    Raises:
        LagnetError: no such route, or motion without commands.
    """
    if asked is not None:
        check_route(asked)
    commanded = all(r.command is not None for r in recordings)
    if asked == "motion" and not commanded:
        raise LagnetError("--route motion needs command_i in every recording", next_step="use --route torque")
    without_torque = all(r.tau is None and r.current is None for r in recordings)
    return asked or ("motion" if commanded and without_torque else "torque")


def refuse_servo_options(actuator: object, gains: object, next_step: str | None = None) -> None:
    """Refuses options of servos where recordings are judged by torque.

    Raises:
        LagnetError: names the option.
    """
    for value, option in ((actuator, "--actuator"), (gains, "--gains")):
        if value:
            raise LagnetError(
                "the recordings hold torque, to which no servo matters", where=option, next_step=next_step
            )


def diagnose_on_motion(
    fit: Sequence[Recording],
    robot: Any,
    holdout: Sequence[Recording] | None,
    out: Path,
    actuator: Path | None,
    gains: Sequence[float] | None,
    simulator: ReplaySettings | None,
    seed: int,
) -> None:
    """Diagnoses, writes verdict, table, corrected model and report, and says what was found."""
    from dataclasses import replace

    from lagnet.cli.parts.replayed import replay_held_out
    from lagnet.cli.shared.console import say
    from lagnet.diagnosis.motion.diagnose import diagnose_motion
    from lagnet.diagnosis.motion.writing import write_motion_diagnosis
    from lagnet.files import write_together
    from lagnet.reports.motion_report import write_motion_report
    from lagnet.servos.servo_file import read_servo_file

    servo = None
    if actuator is not None:
        if not hasattr(robot, "armature"):
            raise LagnetError("--actuator describes the servos of a robot file", next_step="give a URDF or MJCF")
        servo = read_servo_file(actuator, robot.joints, robot.armature)
    say("diagnosing on motion: the recordings hold commands and no torque")
    result = diagnose_motion(fit, robot, holdout, servo=servo, gains=gains, seed=seed)

    def fill(folder: Path) -> None:
        write_motion_diagnosis(result, folder)
        write_motion_report(result, folder / "report.html")

    write_together(out, fill, last="verdict.json")
    if simulator:
        held = tuple(gains or ())[len(fit) if holdout else 0 :]
        replayed = replay_held_out(result, replace(simulator, gains=held), out)
        write_motion_report(result, out / "report.html", replayed)
    for effect in result.effects:
        say(effect.explanation)
    if not result.effects:
        say("No left-out physics was found." if not result.verdict.found else "The mismatch fits no known physics.")
    say(f"report: {out / 'report.html'}")
