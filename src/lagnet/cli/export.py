"""`lagnet export`: a corrected model written for a simulator."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from lagnet.cli.shared.options import Columns, ServoGains, ServoKd, ServoKp, TorqueConstant
from lagnet.errors import LagnetError
from lagnet.percent import percent

if TYPE_CHECKING:
    from lagnet.simulators.exported import Export
    from lagnet.simulators.exporter import Exporter, Place
    from lagnet.simulators.servo_exporters.servo_exporter import ServoExporter


def command(
    corrected: Annotated[
        str, typer.Argument(help="A folder written by diagnose, or a URDF, MJCF or name such as ur5.")
    ],
    to: Annotated[str, typer.Option("--to", help="mjcf, urdf, sdf, usd, pybullet, drake or isaaclab.")],
    out: Annotated[Path, typer.Option(help="Folder to write.")] = Path("export"),
    verify: Annotated[
        list[Path] | None, typer.Option(help="Recordings to simulate in that engine (mjcf, pybullet).")
    ] = None,
    columns: Columns = None,
    torque_constant: TorqueConstant = None,
    kp: ServoKp = None,
    kd: ServoKd = None,
    gains: ServoGains = None,
) -> None:
    """Write a corrected model for a simulator, and say of every effect what it became."""
    from lagnet.cli.shared.console import numbers, say
    from lagnet.cli.shared.reading import while_reading
    from lagnet.cli.shared.replays import servo_of
    from lagnet.models.files.loading import load_any
    from lagnet.recordings.loading.load import load_recording
    from lagnet.simulators.before_after import verify as verified_by
    from lagnet.simulators.export import export_model
    from lagnet.simulators.exported import write_export_json
    from lagnet.simulators.registry import exporter_named
    from lagnet.simulators.replay import ReplaySettings

    exporter = exporter_named(to)
    if verify and exporter.engine is None:
        raise LagnetError(
            f"no engine here runs {to}", where="--verify", next_step="verify with --to mjcf or --to pybullet"
        )
    model = load_any(corrected)
    written = export_model(model, exporter, out)
    result = None
    if verify and exporter.engine is not None:
        of_servos = tuple(numbers(gains, "--gains")) if gains else ()
        settings = ReplaySettings(engine=exporter.engine, servo=servo_of(kp, kd), gains=of_servos)
        constants = numbers(torque_constant, "--torque-constant") if torque_constant else None
        read = [
            load_recording(p, robot=model, columns=columns, torque_constant=constants, progress=while_reading())
            for p in verify
        ]
        result = verified_by(model, read, settings)
    listed = write_export_json(written, out, result)
    joints = written.arm.robot.joints
    for effect, place in written.places:
        where = "whole arm" if effect.joint is None else joints[effect.joint]
        say(f"{effect.effect} ({where}): {_words(written.exporter, effect.effect, place)}")
    for (kind, words), where in _identified(written).items():
        said = "every joint" if len(where) == len(joints) > 1 else ", ".join(where)
        say(f"identified {kind} ({said}): {words}")
    if written.remainder is not None:
        say(f"learned remainder: {_words(written.exporter, '', written.remainder)}")
    if result is not None:
        for i, joint in enumerate(joints):
            after = (result["after"] or result["before"])["rmse"][i]
            before, gap, unit = (
                result["before"]["rmse"][i],
                result["engine_against_corrected_rmse"][i],
                result["units"][i],
            )
            against = f"to what was measured {before:.3g} {unit} before, {after:.3g} after"
            say(f"{joint}: error of {exporter.engine} {against}; to the corrected model {gap:.2g}")
    say(f"written: {written.files[0]} and {listed}")


def _identified(written: Export) -> dict[tuple[str, str], list[str]]:
    """Joints of the identified parts, by their kind and what became of them."""
    out: dict[tuple[str, str], list[str]] = {}
    for part, place in written.identified:
        alike = "" if part.alike is None else part.alike.effect
        key = part.kind.replace("_", " "), _words(written.exporter, alike, place)
        joint, where = written.arm.robot.joints[part.joint], out.setdefault(key, [])
        if joint not in where:  # a joint has several bristles
            where.append(joint)
    return out


def _words(exporter: Exporter | ServoExporter, effect: str, place: Place) -> str:
    """Status, the measured error of what is approximate, and element or reason."""
    measured = exporter.measured(effect) if place.status == "approximate" else {}
    off = "".join(f", {percent(share, 3)} off in {engine}" for engine, share in measured.items())
    return f"{place.status.replace('_', ' ')}{off}: {place.element or place.note}"
