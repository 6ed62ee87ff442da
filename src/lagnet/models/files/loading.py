"""Any model by what the user calls it: a robot's name or file, or a folder that `train` or `diagnose` wrote."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from lagnet.errors import ModelError
from lagnet.models.corrected import folder as corrected_files
from lagnet.rigid_body.descriptions.description import NONE_HELD


def load_any(spec: str | Path, held: Mapping[str, float] = NONE_HELD, *, layers: str = "full") -> Any:
    """A Robot, a learned model, an ensemble of them or a corrected model.

    Args:
        spec: URDF or MJCF path, name of example-robot-data, or folder written by `train` or `diagnose`.
        held: joints of a URDF, MJCF or named robot that no recording tells of, e.g. fingers, and where they are held
            still [rad or m].
        layers: of a corrected model: "named" physics alone, with what is "identified" beside it, or "full".

    Raises:
        RobotError: no such robot, or a description that cannot be read.
        ModelError: a folder that holds no model, or a damaged one; or joints to hold of a model that has none to spare.
    """
    path = Path(spec)
    if not path.is_dir() or _means_the_robot(spec):
        from lagnet.rigid_body.robot import load_description

        return load_description(spec, held)
    if held:
        raise ModelError("has the joints that it was made with: none can be held still", where=str(path))
    for folder in (path, path / "corrected", path / "model"):
        if (folder / corrected_files.FILE).is_file():
            return corrected_files.load_corrected(folder, load_any, layers)
        if (folder / "servo.json").is_file():
            from lagnet.models.corrected.servo_files import load_servo_driven

            return load_servo_driven(folder, load_any)
        if (folder / "ensemble.json").is_file():
            from lagnet.models.files.ensemble_files import load_ensemble

            return load_ensemble(folder)
        if (folder / "model.json").is_file():
            from lagnet.models.files.saving import load_model

            return with_bodies(load_model(folder))
    raise ModelError(
        "the folder holds neither a trained nor a corrected model",
        where=str(path),
        next_step="give a folder written by `lagnet train` or `lagnet diagnose`, or a URDF or MJCF file",
    )


def _means_the_robot(spec: str | Path) -> bool:
    """Whether a word that is a robot's name and a folder here as well means the robot: the folder holds no model.

    Raises:
        ModelError: the folder holds one, so that either may be meant.
    """
    from lagnet.rigid_body.descriptions.named_robots import named_robots

    if isinstance(spec, Path) or spec not in named_robots():
        return False
    files = ("model.json", "ensemble.json", corrected_files.FILE)
    if not any((Path(spec) / part / file).is_file() for part in ("", "corrected", "model") for file in files):
        return True
    raise ModelError(
        f"'{spec}' is a robot's name and a folder with a model here",
        next_step=f"write ./{spec} for the folder, or rename it if the robot is meant",
    )


def with_bodies(model: Any) -> Any:
    """The same model; a serial chain also answers for its links, so that a diagnosis can ask which of them is wrong."""
    if model.model_kind != "serial-chain":
        return model
    from lagnet.models.serial_chain.model import SerialChain

    return SerialChain(model)
