"""What a sensor does to a payload's torque is found although the nominal model has no payload."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.regression.library import Hypothesis
from lagnet.diagnosis.selection.iterated_search import _bears_its_columns, _carried_over
from lagnet.models.corrected.named_effects import NamedEffect

MASS = 1.5  # [kg]
TILTED = np.array([0.9, -0.7, -9.7])  # [m s⁻²]


@pytest.fixture(scope="module")
def loaded(arm):
    return arm.with_payload(MASS, np.array([0.05, 0.08, 0.15]), 0.006 * np.eye(3))


@pytest.mark.slow
def test_a_limit_that_only_the_loaded_arm_reaches_is_named(plant, arm, loaded, at, names) -> None:
    limit = 1.02 * max(float(np.abs(plant().record(s).tau[:, 0]).max()) for s in (1, 2, 3))
    real = plant(at(0, lambda q, v, a, body: np.clip(body, -limit, limit) - body), robot=loaded)
    result = diagnose([real.record(1), real.record(2)], arm, [real.record(3)])
    assert names(result) == {("payload", None), ("saturation", arm.joints[0])}
    found = {e.effect: e for e in result.effects}
    assert found["saturation"].value("tau_max") == pytest.approx(limit, rel=0.01)
    assert found["payload"].value("m") == pytest.approx(MASS, rel=0.02)


@pytest.mark.parametrize("share", [0.15, 0.4])
def test_a_limit_that_only_friction_reaches_is_named(plant, arm, at, names, share: float) -> None:
    limit = 1.02 * max(float(np.abs(plant().record(s).tau[:, 1]).max()) for s in (1, 2, 3))
    drag = share * limit
    real = plant(at(1, lambda q, v, a, body: np.clip(body + drag * v, -limit, limit) - body))
    result = diagnose([real.record(1), real.record(2)], arm, [real.record(3)])
    assert names(result) == {("viscous_friction", arm.joints[1]), ("saturation", arm.joints[1])}
    found = {e.effect: e for e in result.effects}
    assert found["saturation"].value("tau_max") == pytest.approx(limit, rel=0.01)
    assert found["viscous_friction"].value("Fv") == pytest.approx(drag, rel=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("gain", [0.8, 1.25])
def test_a_gain_of_a_joint_that_the_payload_loads_is_named(plant, arm, loaded, at, names, gain: float) -> None:
    real = plant(at(2, lambda q, v, a, body: (gain - 1.0) * body), robot=loaded)
    result = diagnose([real.record(1), real.record(2)], arm, [real.record(3)])
    assert names(result) == {("payload", None), ("torque_gain", arm.joints[2])}
    found = {e.effect: e for e in result.effects}
    assert found["torque_gain"].value("g") == pytest.approx(gain, rel=0.01)


def test_friction_behind_a_payload_is_no_gain(plant, arm, loaded, at, names) -> None:
    real = plant(at(2, lambda q, v, a, body: 3.0 * v + 2.0 * np.tanh(v / 1e-3)), robot=loaded)
    result = diagnose([real.record(1), real.record(2)], arm, [real.record(3)])
    own = {("viscous_friction", arm.joints[2]), ("coulomb_friction", arm.joints[2])}
    assert names(result) == {("payload", None), *own}


@pytest.mark.slow
def test_a_limit_behind_a_payload_on_a_tilted_base_hides_neither(plant, arm, at, names) -> None:
    tilted = arm.with_payload(0.3, np.array([0.05, 0.08, 0.15]), 0.0012 * np.eye(3)).with_gravity(TILTED)
    limit = 0.6 * float(np.abs(plant(robot=tilted).record(3).tau[:, 1]).max())
    real = plant(at(1, lambda q, v, a, body: np.clip(body, -limit, limit) - body), robot=tilted)
    result = diagnose([real.record(1), real.record(2)], arm, [real.record(3)])
    assert names(result) == {("payload", None), ("gravity_tilt", None), ("saturation", arm.joints[1])}


@pytest.mark.slow
def test_a_payload_heavier_than_the_arm_leaves_the_tilt_of_its_base_visible(plant, arm, loaded, names) -> None:
    real = plant(robot=loaded.with_gravity(TILTED))
    result = diagnose([real.record(1), real.record(2)], arm, [real.record(3)])
    assert names(result) == {("payload", None), ("gravity_tilt", None)}


@pytest.mark.slow
def test_an_encoder_offset_on_a_tilted_base_is_no_body(plant, arm, names) -> None:
    """What the tilt made linear leaves, and the product of both, looked like a payload."""
    real, delta = plant(robot=arm.with_gravity(9.81 * TILTED / np.linalg.norm(TILTED))), np.zeros(arm.n_dof)
    delta[2] = 0.04
    seen = [replace(r, q=r.q - delta) for r in (real.record(s) for s in (1, 2, 3))]
    result = diagnose(seen[:2], arm, seen[2:])
    assert names(result) == {("gravity_tilt", None), ("encoder_offset", arm.joints[2])}
    found = {e.effect: e for e in result.effects}
    assert found["encoder_offset"].value("delta") == pytest.approx(0.04, rel=0.02)


def test_columns_of_a_body_that_is_not_selected_bear_no_selection(plant, arm) -> None:
    """Gains of a load that nobody names would explain this load, and pay for no body."""
    posed = pose(arm, plant().record(1), plant().record(2))
    body = {"m": MASS, "cx": 0.05, "cy": 0.08, "cz": 0.15, "Ixx": 0.006, "Iyy": 0.006, "Izz": 0.006}
    known = (NamedEffect("payload", None, {"Ixy": 0.0, "Ixz": 0.0, "Iyz": 0.0, **body}),)
    near = (NamedEffect("payload", None, {**known[0].values, "m": 0.8 * MASS}),)
    problem = replace(posed.problem, known=known)
    assert _bears_its_columns(problem, known)
    assert _bears_its_columns(problem, near)
    assert not _bears_its_columns(problem, ())
    assert _bears_its_columns(posed.problem, ())


def test_a_link_told_by_its_mass_is_carried_over_with_all_ten(plant, arm) -> None:
    """Masses are made after the search, of what it selected: the library of the next round has free links alone."""
    posed = pose(arm, plant().record(61), plant().record(62))
    mass = Hypothesis("link_inertia", 1, (("form", 1.0),))
    wider = posed.library.with_more([mass], [1])
    found = replace(posed.search(), arm_wide=(len(posed.library.hypotheses),))
    assert _carried_over(wider, found, posed.library).arm_wide == (posed.index("link_inertia", 1),)
