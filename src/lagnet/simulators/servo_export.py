"""Write a servo-driven model for a simulator, and say of every cause and parameter what it became."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.models.corrected.servo_driven import ServoDrivenModel
from lagnet.rollout.surface import BODY, SURFACE
from lagnet.servos.catalogue import SERVO_CATALOGUE
from lagnet.servos.parameters import INDEX, LAW, NEUTRAL
from lagnet.simulators.corrected_arm.identified_parts import IdentifiedPart
from lagnet.simulators.corrected_arm.servo_arm import servo_arm
from lagnet.simulators.exported import Export
from lagnet.simulators.exporter import Exporter, Place
from lagnet.simulators.servo_exporters.registry import SERVO_EXPORTERS
from lagnet.simulators.servo_exporters.servo_exporter import CAUSE_OF, CAUSES, ServoExporter

COMMANDS = {"driven_by": "position commands"}


def export_servos(model: ServoDrivenModel, exporter: Exporter, out: Path) -> Export:
    """Write a servo-driven model's files.

    Raises:
        ModelError: the model has no bodies, or a joint that feels none.
    """
    writer, arm = SERVO_EXPORTERS[exporter.name], servo_arm(model)
    files = writer.write(arm, out)
    named = tuple(NamedEffect(c.effect, c.joint, c.values) for c in model.causes if c.effect in CAUSES)
    places = tuple((e, writer.places[e.effect]) for e in named)
    more = COMMANDS | {"scale_is_set": list(model.scale_is_set)}
    return Export(writer, arm.arm, files, places, _identified(model, writer, named), more=more)


def _identified(
    model: ServoDrivenModel, writer: ServoExporter, named: tuple[NamedEffect, ...]
) -> tuple[tuple[IdentifiedPart, Place], ...]:
    """Parameters of laws that differ from before, or from none where that is not known, and are in nobody's name."""
    before = np.tile(NEUTRAL, (model.n_dof, 1)) if model.before is None else model.before.laws
    parts = []
    for parameter in LAW:
        column = INDEX[parameter.name]
        for j in np.flatnonzero(~np.isclose(model.laws[:, column], before[:, column], rtol=1e-6, atol=0.0)).tolist():
            if not any(e.joint == j and parameter.name in _parameters_of(e.effect) for e in named):
                parts.append(_part(parameter.name, j, {parameter.name: float(model.laws[j, column])}, writer))
    if model.surface is not None and all(e.effect != "surface_contact" for e in named):
        values: dict[str, Any] = dict(zip(SURFACE, map(float, model.surface), strict=True))
        alike = NamedEffect("surface_contact", None, values)
        part = IdentifiedPart("surface", int(model.surface[BODY]), values, alike)
        parts.append((part, writer.places["surface_contact"]))
    return tuple(parts)


def _part(name: str, joint: int, values: dict[str, float], writer: ServoExporter) -> tuple[IdentifiedPart, Place]:
    alike = NamedEffect(CAUSE_OF[name], joint, values)
    return IdentifiedPart(name, joint, values, alike), writer.place_of_parameter(name)


def _parameters_of(effect: str) -> tuple[str, ...]:
    """Law parameters that a cause sets."""
    if effect not in SERVO_CATALOGUE:
        return ()
    law = SERVO_CATALOGUE[effect]
    return (*(name for names in law.frees for name in names), *law.chosen, *law.with_it)
