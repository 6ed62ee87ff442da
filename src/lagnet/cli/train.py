"""`lagnet train`: learn a dynamics model from recordings, to a folder that is a ROBOT for every other command."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from lagnet.cli.shared.options import Columns
from lagnet.percent import percent

if TYPE_CHECKING:
    from lagnet.training.settings import TrainingSettings

INTERRUPTED = 3


def command(
    recordings: Annotated[list[Path], typer.Argument(help="Recordings (.csv, .csv.gz, .parquet, .npz, .mat).")],
    model: Annotated[
        str, typer.Option(help="delan, delan-perceptron, delan-blackbox, ffnn, delan-ffnn or serial-chain.")
    ] = "delan",
    out: Annotated[Path, typer.Option(help="Folder to write.")] = Path("model"),
    holdout: Annotated[
        list[Path] | None, typer.Option(help="Recording to judge by; repeatable. Default: last fifth of each.")
    ] = None,
    seed: Annotated[int, typer.Option(help="Seed of initial weights and shuffling.")] = 0,
    minutes: Annotated[float | None, typer.Option(help="Wall-clock limit of the training.")] = None,
    steps: Annotated[
        int | None, typer.Option(help="Gradient steps; unlike minutes they give the same model again.")
    ] = None,
    columns: Columns = None,
    joint_types: Annotated[
        str | None, typer.Option(help="Comma-separated: continuous, revolute or prismatic for each joint.")
    ] = None,
    cores: Annotated[
        int | None, typer.Option(min=1, help="Processor cores to train on; the same number gives the same model again.")
    ] = None,
    penalty: Annotated[
        float | None, typer.Option(help="λ of eq. 12: trains mechanics and ε of delan-ffnn together, not in stages.")
    ] = None,
) -> None:
    """Learn a dynamics model from recordings; a killed run goes on where it was when called again."""
    from lagnet.cli.shared.console import above_zero, not_negative, say
    from lagnet.recordings.loading.load import load_recording
    from lagnet.training.cores import let_jax_see_cores
    from lagnet.training.stages import stage_files
    from lagnet.training.train import train

    above_zero(minutes, "--minutes")
    above_zero(steps, "--steps")
    not_negative(penalty, "--penalty")
    not_negative(seed, "--seed")
    let_jax_see_cores(cores)
    read = [load_recording(path, columns=columns) for path in recordings]
    judged = [load_recording(path, columns=columns) for path in holdout or []]
    types = tuple(name.strip() for name in joint_types.split(",")) if joint_types else None
    checkpoint = out / "training_checkpoint.npz"
    fit = train(
        read,
        model,
        seed=seed,
        holdout=judged or None,
        minutes=minutes,
        training=_how(steps, penalty),
        joint_types=types,
        checkpoint=checkpoint,
        progress=lambda report: say(report.line()) if report.step % 500 == 0 else None,
    )
    if fit.stats.get("interrupted") and holds_finished_model(out):
        say(f"interrupted: the finished model in {out} was kept as it is; the same command goes on from here")
        raise typer.Exit(INTERRUPTED)
    fit.model.save(out)
    for joint, error in zip(fit.model.joints, fit.stats.get("held_out_error") or (), strict=False):
        say(f"{joint}: held-out torque error {percent(error, 3)} of its variance")
    say(f"model: {out}")
    if fit.stats.get("interrupted"):
        say("interrupted: the best model so far was kept; the same command goes on from there")
        raise typer.Exit(INTERRUPTED)
    for file in (checkpoint, *stage_files(checkpoint)):
        file.unlink(missing_ok=True)


def holds_finished_model(folder: Path) -> bool:
    """Whether a folder holds a model whose training came to its end."""
    from lagnet.errors import ModelError
    from lagnet.models.files.saving import load_model

    try:
        return not load_model(folder).training.get("interrupted", False)
    except ModelError:
        return False


def _how(steps: int | None, penalty: float | None) -> TrainingSettings:
    """The defaults but for what was asked for; a λ weighs ε against torque while both are trained together."""
    from lagnet.training.settings import TrainingSettings

    settings = TrainingSettings() if steps is None else TrainingSettings(steps=steps)
    return settings if penalty is None else replace(settings, penalty=penalty, separation="joint")
