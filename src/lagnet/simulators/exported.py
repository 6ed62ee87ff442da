"""What an export wrote: the places of every effect and part, and `export.json`."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lagnet._version import __version__
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.rigid_body.descriptions.writing import write_text
from lagnet.simulators.corrected_arm.arm_physics import ArmPhysics
from lagnet.simulators.corrected_arm.identified_parts import IdentifiedPart
from lagnet.simulators.exporter import Exporter, Place
from lagnet.simulators.servo_exporters.servo_exporter import ServoExporter

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
        more: what `export.json` says beside.
    """

    exporter: Exporter | ServoExporter
    arm: ArmPhysics
    files: tuple[Path, ...]
    places: tuple[tuple[NamedEffect, Place], ...]
    identified: tuple[tuple[IdentifiedPart, Place], ...] = ()
    remainder: Place | None = None
    more: Mapping[str, Any] = field(default_factory=dict)

    @property
    def left_out(self) -> tuple[tuple[NamedEffect, Place], ...]:
        """Effects that the simulator has no place for."""
        return tuple(entry for entry in self.places if entry[1].status == "not_representable")


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
        **export.more,
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


def _entry(
    exporter: Exporter | ServoExporter, effect: NamedEffect, place: Place, joints: tuple[str, ...]
) -> dict[str, Any]:
    return {
        "effect": effect.effect,
        "joint": None if effect.joint is None else joints[effect.joint],
        "parameters": effect.parameters(),
        **_place(place, exporter, effect.effect),
    }


def _identified_entry(
    exporter: Exporter | ServoExporter, part: IdentifiedPart, place: Place, joints: tuple[str, ...]
) -> dict[str, Any]:
    return {
        "identified": part.kind,
        "joint": joints[part.joint],
        "parameters": part.values,
        "acts_like": None if part.alike is None else part.alike.effect,
        **_place(place, exporter, "" if part.alike is None else part.alike.effect),
    }


def _place(place: Place, exporter: Exporter | ServoExporter | None = None, effect: str = "") -> dict[str, Any]:
    somewhere = place.status != "not_representable"
    return {
        "status": place.status,
        "element": place.element or None,
        "note" if somewhere else "reason": place.note,
        "measured_error": (dict(exporter.measured(effect)) or None) if exporter and somewhere else None,
    }
