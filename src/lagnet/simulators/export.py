"""Write a corrected model for a simulator, and say of every effect what it became."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lagnet._version import __version__
from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.rigid_body.descriptions.writing import write_text
from lagnet.rigid_body.robot import Robot
from lagnet.simulators.corrected_arm.arm_physics import ArmPhysics, arm_physics
from lagnet.simulators.corrected_arm.identified_parts import IdentifiedPart
from lagnet.simulators.exporter import LEARNED, Exporter, Place, nowhere
from lagnet.simulators.measured import measured_errors

FILE = "export.json"
SCHEMA = "lagnet-export/1"


@dataclass(frozen=True, eq=False)
class Export:
    """What was written.

    Args:
        exporter: for which simulator.
        arm: the physics that was written.
        files: the model first.
        places: every named effect with its place, in the order of the model.
        identified: every part of the identified layer with its place.
        remainder: the place of a learned remainder; None where the model has none.
    """

    exporter: Exporter
    arm: ArmPhysics
    files: tuple[Path, ...]
    places: tuple[tuple[NamedEffect, Place], ...]
    identified: tuple[tuple[IdentifiedPart, Place], ...] = ()
    remainder: Place | None = None

    @property
    def left_out(self) -> tuple[tuple[NamedEffect, Place], ...]:
        """Effects that the simulator has no place for."""
        return tuple(entry for entry in self.places if entry[1].status == "not_representable")


def export_model(model: Robot | CorrectedModel, exporter: Exporter, folder: str | Path) -> Export:
    """Write a model's files; `write_export_json` says what became of it.

    Raises:
        ModelError: the model has no bodies.
    """
    out = Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    arm = arm_physics(model)
    files = exporter.write(arm, out)
    places = tuple((e, exporter.place(e)) for e in all_effects(model))
    identified = tuple((p, nowhere(p.reason) if p.alike is None else exporter.place(p.alike)) for p in arm.identified)
    learned = LEARNED if isinstance(model, CorrectedModel) and model.remainder is not None else None
    return Export(exporter, arm, files, places, identified, learned)


def all_effects(model: Any) -> tuple[NamedEffect, ...]:
    """Named effects of a corrected model and of the corrected models that it stands on."""
    if not isinstance(model, CorrectedModel):
        return ()
    return (*all_effects(model.nominal), *model.effects)


def write_export_json(export: Export, folder: str | Path, verified: Mapping[str, Any] | None = None) -> Path:
    """Writes `export.json`: for each effect the element it became and how exactly; and what was verified.

    Returns:
        The file.
    """
    path = Path(folder) / FILE
    joints = export.arm.robot.joints
    text = {
        "schema": SCHEMA,
        "lagnet": __version__,
        "simulator": export.exporter.name,
        "reads": export.exporter.reads,
        "joints": list(joints),
        "files": [p.name for p in export.files],
        "effects": [_entry(export.exporter, e, p, joints) for e, p in export.places],
        "identified": [_identified_entry(export.exporter, i, p, joints) for i, p in export.identified],
        "remainder": None if export.remainder is None else _place(export.remainder),
        "friction_at_rest": {
            "blur": [float(x) for x in export.arm.blur],
            "unit": "rad/s",
            "meaning": "speed within which the recordings blur the sign of motion; exported friction holds at rest",
        },
        "verify": None if verified is None else dict(verified),
    }
    write_text(path, json.dumps(text, indent=1, allow_nan=False) + "\n")
    return path


def _entry(exporter: Exporter, effect: NamedEffect, place: Place, joints: tuple[str, ...]) -> dict[str, Any]:
    return {
        "effect": effect.effect,
        "joint": None if effect.joint is None else joints[effect.joint],
        "parameters": effect.parameters(),
        **_place(place, exporter, effect.effect),
    }


def _identified_entry(
    exporter: Exporter, part: IdentifiedPart, place: Place, joints: tuple[str, ...]
) -> dict[str, Any]:
    return {
        "identified": part.kind,
        "joint": joints[part.joint],
        "parameters": part.values,
        "acts_like": None if part.alike is None else part.alike.effect,
        **_place(place, exporter, "" if part.alike is None else part.alike.effect),
    }


def _place(place: Place, exporter: Exporter | None = None, effect: str = "") -> dict[str, Any]:
    somewhere = place.status != "not_representable"
    return {
        "status": place.status,
        "element": place.element or None,
        "note" if somewhere else "reason": place.note,
        "measured_error": (dict(measured_errors(exporter.name, effect)) or None) if exporter and somewhere else None,
    }
