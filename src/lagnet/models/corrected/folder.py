"""A corrected model as a folder: its nominal model, the named effects as JSON, and a robot description written back."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import numpy as np

from lagnet.effects.catalogue import effect_named
from lagnet.errors import LagnetError, ModelError
from lagnet.files import finite_json, read_bounded, write_whole
from lagnet.models.corrected.changed_bodies import are_consistent
from lagnet.models.corrected.layer_files import layer_as_json, layer_from_json
from lagnet.models.corrected.model import LAYERS, CorrectedModel
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.models.corrected.remainder.files import remainder_as_json, remainder_from_json
from lagnet.rigid_body.robot import Robot

FORMAT = 8  # 2: with the identified layer; 3: a learned remainder in parts; 4: effects beside a layer in their place;
# 5: torque and friction over position; 6: flexible joints with dampers; 7: what each layer leaves; 8: friction per
# torque of the motor
FILE = "corrected.json"
MOST_BYTES = 10_000_000
LONGEST_NAME = 200


def save_corrected(model: CorrectedModel, folder: str | Path) -> Path:
    """Writes the folder; it holds all that is needed, nothing points outside it.

    Returns:
        The folder.
    """
    out = Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    nominal = _save_nominal(model.nominal, out)
    text = {
        "format": FORMAT,
        "joints": list(model.joints),
        "nominal": nominal,
        "slow": [float(s) for s in model.slow],
        "held": _as_list(model.held),
        "left": None if model.errors is None else {layer: _as_list(row) for layer, row in model.errors.items()},
        "straight": None if model.straight is None else [bool(x) for x in model.straight],
        "effects": [
            {"effect": e.effect, "joint": e.joint, "values": dict(e.values), "interval": e.interval}
            | ({} if e.recording is None else {"recording": e.recording})
            | ({"kept": True} if (e.effect, e.joint) in model.kept else {})
            for e in model.effects
        ],
        "identified": layer_as_json(model.identified),
        "instead": layer_as_json(model.instead),
        "remainder": remainder_as_json(model.remainder),
    }
    write_whole(out / FILE, finite_json(text))
    further = None if model.layer is None else model.layer.bodies
    if isinstance(model.nominal, Robot) and are_consistent(model.nominal, model.acting, further):
        write_description(cast(Robot, model.bodies()), out / "robot")
    return out


def _save_nominal(nominal: Any, out: Path) -> dict[str, str]:
    if isinstance(nominal, Robot):
        path = write_description(nominal, out / "nominal")
        return {"kind": "robot", "file": path.name, "sha256": _checksum(path), "from": nominal.source}
    if isinstance(nominal, CorrectedModel):
        save_corrected(nominal, out / "nominal")
        return {"kind": "corrected", "file": "nominal", "sha256": _checksum(out / "nominal" / FILE)}
    if hasattr(nominal, "save"):
        nominal.save(out / "nominal")
        return {"kind": "learned", "file": "nominal", "sha256": ""}
    raise ModelError(
        f"a nominal model of type {type(nominal).__name__} cannot be saved", next_step="give it a save method"
    )


def write_description(robot: Robot, stem: Path) -> Path:
    """Writes a URDF, or MJCF where the arm has what a URDF cannot hold (rotors, another direction of gravity)."""
    standard = np.allclose(robot.gravity, (0.0, 0.0, -9.81), atol=1e-12)
    if robot.kind != "mjcf" and standard and not robot.armature.any():
        path = stem.with_suffix(".urdf")
        robot.write_urdf(path)
    else:
        path = stem.with_suffix(".xml")
        robot.write_mjcf(path)
    return path


def load_corrected(folder: str | Path, load_any: Callable[[Path], Any], layers: str = "full") -> CorrectedModel:
    """Reads what `save_corrected` wrote.

    Args:
        folder: where it is.
        load_any: reads the nominal model inside the folder.
        layers: of the correction, "named", "identified" or "full".

    Raises:
        ModelError: the folder is damaged or from a newer format.
    """
    where = Path(folder) / FILE
    text = _read(where)
    if not isinstance(text.get("format", 0), int):
        raise ModelError("is damaged (format)", where=str(where), next_step="run the diagnosis again")
    if text.get("format", 0) > FORMAT:
        raise ModelError(f"format {text['format']} is newer than {FORMAT}", where=str(where), next_step="update lagnet")
    try:
        file = Path(folder) / Path(str(text["nominal"]["file"])).name
        expected = str(text["nominal"]["sha256"])
        if len(file.name) > LONGEST_NAME:
            raise ValueError("the name of its nominal model's file is too long")
        effects = tuple(_effect(e, len(text["joints"])) for e in text["effects"])
        slow = np.array([float(s) for s in text["slow"]])
        joints = tuple(map(str, text["joints"]))
        kept = frozenset((e.effect, e.joint) for e, t in zip(effects, text["effects"], strict=True) if t.get("kept"))
        identified, instead = (layer_from_json(text.get(k), len(joints)) for k in ("identified", "instead"))
        remainder = remainder_from_json(text.get("remainder"), len(joints)) if layers == "full" else None
        held, straight = (_as_row(text.get(name)) for name in ("held", "straight"))
        errors = _errors(text.get("left"))
    except (KeyError, TypeError, ValueError, LagnetError) as error:
        raise ModelError(f"is damaged ({error})", where=str(where), next_step="run the diagnosis again") from None
    seen = file if file.is_file() else file / FILE
    if expected and (not seen.is_file() or _checksum(seen) != expected):
        raise ModelError("the nominal model beside it was changed or is missing", where=str(seen))
    nominal = load_any(file)
    if tuple(nominal.joints) != joints or any(
        len(x) != len(joints) for x in (slow, held, straight, *(errors or {}).values()) if x is not None
    ):
        raise ModelError("its joints are not those of its nominal model", where=str(where))
    straight = None if straight is None else straight.astype(bool)
    of_file = (str(folder), _checksum(where))
    model = CorrectedModel(nominal, effects, slow, held, straight, *of_file, errors=errors, identified=identified)
    model = replace(model, instead=instead, kept=kept, remainder=remainder)
    return model.with_layers(layers)


def _errors(entry: Any) -> dict[str, np.ndarray] | None:
    """What each layer leaves; older folders tell it of the named one alone, and no other is known to leave less."""
    if entry is None:
        return None
    rows = {layer: _as_row(entry[layer] if isinstance(entry, dict) else entry) for layer in LAYERS}
    if any(row is None for row in rows.values()):
        raise ValueError("it does not tell what each layer leaves")
    return cast(dict[str, np.ndarray], rows)


def _as_list(row: np.ndarray | None) -> list[float] | None:
    return None if row is None else [float(x) for x in row]


def _as_row(entry: Any) -> np.ndarray | None:
    if entry is None:
        return None
    row = np.array([float(x) for x in entry])
    if not np.isfinite(row).all():
        raise ValueError("a number is not finite")
    return row


def _read(where: Path) -> dict[str, Any]:
    try:
        if where.stat().st_size > MOST_BYTES:
            raise ModelError("is far larger than any corrected model", where=str(where))
        text = json.loads(read_bounded(where, MOST_BYTES).decode("utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        raise ModelError(f"cannot be read ({error})", where=str(where)) from None
    if not isinstance(text, dict):
        raise ModelError("holds no object", where=str(where))
    return text


def _effect(entry: Any, n_dof: int) -> NamedEffect:
    law = effect_named(str(entry["effect"]))
    joint = entry["joint"]
    if (joint is None) != law.whole_arm or (joint is not None and not 0 <= int(joint) < n_dof):
        raise ValueError(f"{law.name} at joint {joint}")
    held = law.with_names_of_today(entry["values"])
    values = {p.name: float(held[p.name]) for p in law.parameters}
    if not all(map(math.isfinite, values.values())):
        raise ValueError(f"{law.name} has a parameter that is not finite")
    interval, recording = entry.get("interval"), entry.get("recording")
    return NamedEffect(
        law.name,
        joint,
        values,
        None if interval is None else (float(interval[0]), float(interval[1])),
        None if recording is None else int(recording),
    )


def _checksum(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()
