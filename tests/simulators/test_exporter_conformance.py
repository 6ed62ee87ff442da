"""What every exporter owes: a place or a reason for every effect, files, and claims that were measured."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from lagnet.effects.catalogue import CATALOGUE
from lagnet.errors import LagnetError, ModelError
from lagnet.models.corrected.model import CorrectedModel, NamedEffect
from lagnet.simulators.corrected_arm.arm_physics import arm_physics
from lagnet.simulators.export import export_model
from lagnet.simulators.exported import write_export_json
from lagnet.simulators.measured import measured_errors
from lagnet.simulators.registry import EXPORTERS, exporter_named
from lagnet.simulators.round_trips.reference_cases import CASES, case_values

LASTING = {name for name, law in CATALOGUE.items() if not law.is_transient}
EXACT = 0.01  # of an effect's own contribution, the pass line of validation/round_trip


@pytest.fixture(params=list(EXPORTERS))
def exporter(request: pytest.FixtureRequest):
    return EXPORTERS[request.param]


def test_it_has_a_place_or_a_reason_for_every_effect(exporter) -> None:
    assert set(exporter.places) == LASTING == set(CASES)
    for place in exporter.places.values():
        if place.status == "not_representable":
            assert place.element == ""
            assert len(place.note) > 15
        else:
            assert place.element
        assert place.status != "approximate" or place.note


def test_exact_was_measured_below_one_percent(exporter) -> None:
    for name in CASES:
        place = exporter.place_of_values(name, case_values(name))
        errors = measured_errors(exporter.name, name)
        if place.status == "exact":
            assert all(share < EXACT for share in errors.values()), (name, errors)
        if exporter.engine is not None and place.status != "not_representable":
            assert exporter.engine in errors, f"{name} was never measured in {exporter.engine}"


def test_it_writes_files_and_tells_of_every_effect(exporter, corrected: CorrectedModel, tmp_path: Path) -> None:
    written = export_model(corrected, exporter, tmp_path)
    assert written.files
    assert all(path.stat().st_size for path in written.files)
    text = json.loads(write_export_json(written, tmp_path).read_text(encoding="utf-8"))
    assert [e["effect"] for e in text["effects"]] == [e.effect for e in corrected.effects]
    for entry in text["effects"]:
        assert entry["status"] in ("exact", "approximate", "not_representable")
        assert entry["parameters"]
        assert bool(entry["element"]) == (entry["status"] != "not_representable")
        assert entry.get("reason") if entry["status"] == "not_representable" else "note" in entry


def test_what_passes_is_not_written(exporter, corrected: CorrectedModel) -> None:
    brief = NamedEffect("payload", None, case_values("payload"), interval=(1.0, 2.0))
    assert exporter.place(brief).status == "not_representable"
    arm = arm_physics(corrected.with_effects([brief]))
    np.testing.assert_allclose(arm.robot.inertial_parameters(), corrected.nominal.inertial_parameters(), atol=1e-12)
    assert arm.transient == (brief,)


def test_layers_of_corrections_add_up(corrected: CorrectedModel) -> None:
    more = CorrectedModel(corrected, (NamedEffect("viscous_friction", 0, {"Fv": 0.2}),), np.full(3, 1e-3))
    assert arm_physics(more).viscous[0] == pytest.approx(1.0)


def test_an_unknown_simulator_and_a_model_without_bodies_are_refused() -> None:
    with pytest.raises(LagnetError, match="no exporter writes for 'gazebo'"):
        exporter_named("gazebo")
    with pytest.raises(ModelError, match="no bodies to export"):
        arm_physics(CorrectedModel(object(), (), np.zeros(1)))
