"""Write a corrected model for a simulator, and say of every effect what it became."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.models.corrected.servo_driven import ServoDrivenModel
from lagnet.rigid_body.robot import Robot
from lagnet.simulators.corrected_arm.arm_physics import arm_physics
from lagnet.simulators.exported import Export
from lagnet.simulators.exporter import LEARNED, Exporter, nowhere
from lagnet.simulators.servo_export import export_servos


def export_model(model: Robot | CorrectedModel | ServoDrivenModel, exporter: Exporter, folder: str | Path) -> Export:
    """Write a model's files; `write_export_json` says what became of it.

    Raises:
        ModelError: the model has no bodies.
    """
    out = Path(folder)
    out.mkdir(parents=True, exist_ok=True)
    if isinstance(model, ServoDrivenModel):
        return export_servos(model, exporter, out)
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
