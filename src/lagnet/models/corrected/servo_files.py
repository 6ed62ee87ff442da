"""A servo-driven model as a folder: its robot, every servo's law by name, what was found, and what it corrects."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from lagnet.errors import ModelError
from lagnet.files import finite_json, write_whole
from lagnet.models.corrected.folder import LONGEST_NAME, MOST_BYTES, write_description
from lagnet.models.corrected.servo_driven import FoundCause, ServoDrivenModel
from lagnet.rollout.surface import BODY, FRICTION, HARDNESS, SURFACE
from lagnet.servos.parameters import LAW, NAMES, NO_LIMIT

FORMAT = 1
FILE = "servo.json"
MOST_CAUSES = 1000


def save_servo_driven(model: ServoDrivenModel, folder: str | Path) -> Path:
    """Writes the folder; it holds all that is needed, nothing points outside it.

    Returns:
        The folder.
    """
    out = Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    joints = model.joints
    causes = [
        {"effect": c.effect, "joint": None if c.joint is None else joints[c.joint], "status": c.status}
        | {"values": {name: float(x) for name, x in c.values.items()}}
        for c in model.causes
    ]
    text = {
        "format": FORMAT,
        "joints": list(joints),
        **_servos(model, write_description(model.nominal, out / "robot")),
        "units": {p.name: p.unit for p in LAW},
        "found": {"effects": causes},
    }
    if model.before is not None:
        text["nominal"] = _servos(model.before, write_description(model.before.nominal, out / "nominal"))
    write_whole(out / FILE, finite_json(text))
    return out


def _servos(model: ServoDrivenModel, description: Path) -> dict[str, Any]:
    surface = None if model.surface is None else dict(zip(SURFACE, map(float, model.surface), strict=True))
    return {
        "robot": description.name,
        "voltage": model.voltage,
        "scale_is_set": list(model.scale_is_set),
        "laws": [{n: float(x) for n, x in zip(NAMES, law, strict=True)} for law in model.laws],
        **({} if surface is None else {"surface": surface}),
    }


def load_servo_driven(folder: str | Path, load_robot: Callable[[Path], Any]) -> ServoDrivenModel:
    """Reads what `save_servo_driven` wrote; `load_robot` reads the descriptions inside.

    Raises:
        ModelError: the folder is damaged or from a newer format.
    """
    where = Path(folder) / FILE
    try:
        if where.stat().st_size > MOST_BYTES:
            raise ModelError("is far larger than any servo-driven model", where=str(where))
        text = json.loads(where.read_text(encoding="utf-8"))
        if int(text.get("format", 0)) > FORMAT:
            raise ModelError(f"format {text['format']} is newer than {FORMAT}", where=str(where))
        model = _model(text, text["joints"], Path(folder), load_robot)
        before = None if "nominal" not in text else _model(text["nominal"], text["joints"], Path(folder), load_robot)
        causes = tuple(_cause(c, model.joints) for c in text.get("found", {}).get("effects", [])[:MOST_CAUSES])
    except (OSError, KeyError, TypeError, ValueError, AttributeError, RecursionError) as error:
        raise ModelError(f"is damaged ({error})", where=str(where), next_step="run the diagnosis again") from None
    return replace(model, causes=causes, before=before, source=str(folder))


def _model(text: Any, joints: Any, folder: Path, load_robot: Callable[[Path], Any]) -> ServoDrivenModel:
    laws = np.array([[float(law.get(p.name, p.neutral)) for p in LAW] for law in text["laws"]])
    scales, voltage = tuple(bool(x) for x in text["scale_is_set"]), float(text["voltage"])
    robot = load_robot(folder / Path(str(text["robot"])[:LONGEST_NAME]).name)
    surface = _surface(text.get("surface"), robot.n_dof)
    fits = laws.shape == (robot.n_dof, len(NAMES)) and len(scales) == robot.n_dof and np.isfinite(laws).all()
    if not fits or list(robot.joints) != list(joints) or not math.isfinite(voltage):
        raise ValueError("its joints are not those of its robot")
    bounds = np.array([[p.lower, p.upper] for p in LAW]).T
    if (laws < bounds[0]).any() or (laws > np.minimum(bounds[1], NO_LIMIT)).any():
        raise ValueError("a parameter is out of its bounds")
    return ServoDrivenModel(robot, laws, scales, voltage, surface)


def _cause(entry: Any, joints: tuple[str, ...]) -> FoundCause:
    joint = entry["joint"]
    values = {str(name): float(x) for name, x in entry.get("values", {}).items()}
    if not all(map(math.isfinite, values.values())):
        raise ValueError("a parameter is not finite")
    place = None if joint is None else joints.index(str(joint))
    return FoundCause(str(entry["effect"]), place, str(entry["status"]), values)


def _surface(given: Any, n_dof: int) -> np.ndarray | None:
    if given is None:
        return None
    surface = np.array([float(given[name]) for name in SURFACE])
    whole = surface[BODY] == int(surface[BODY]) and 0 <= surface[BODY] < n_dof
    if not np.isfinite(surface).all() or not whole or not surface[HARDNESS] > 0.0 or surface[FRICTION] < 0.0:
        raise ValueError("its surface is none that an arm could touch")
    return surface
