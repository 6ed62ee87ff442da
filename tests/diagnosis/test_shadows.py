"""Small names beside a payload that only take back what its fit overdid are left out; small ones of their own stay."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.diagnosis.posed import Posed, pose

from lagnet.diagnosis.arm_search import Found, refit_found
from lagnet.diagnosis.shadows import drop_shadows

MASS = 1.5  # [kg]


@pytest.fixture(scope="module")
def loaded(arm):
    return arm.with_payload(MASS, np.array([0.05, 0.08, 0.15]), 0.006 * np.eye(3))


def with_gains(posed: Posed, keep_friction: bool) -> Found:
    """The payload with a gain at every joint, whether the search chose them or not."""
    hypotheses = posed.library.hypotheses
    far = tuple(i for i, h in enumerate(hypotheses) if h.effect == "payload")
    names = ("torque_gain", "viscous_friction") if keep_friction else ("torque_gain",)
    local = tuple(
        tuple(
            i for i in own if hypotheses[i].effect in names and (hypotheses[i].effect != "viscous_friction" or j == 1)
        )
        for j, own in enumerate(posed.library.local)
    )
    return refit_found(posed.bench, replace(posed.search(), far=far, local=local))


def test_gains_that_a_payload_does_not_need_go(plant, arm, loaded) -> None:
    real = plant(robot=loaded)
    posed = pose(arm, real.record(1), real.record(2))
    found = drop_shadows(posed.bench, with_gains(posed, False))
    assert len(found.far) == 1
    assert found.local == ((), (), ())
    assert set(found.fit.coefficients) == set(found.selection)


def test_a_small_effect_of_its_own_stays(plant, arm, loaded, at) -> None:
    level = 0.1 * plant(robot=loaded).usual_torque()[1]
    real = plant(at(1, lambda q, v, a, body: level * v), robot=loaded)
    posed = pose(arm, real.record(1), real.record(2))
    found = drop_shadows(posed.bench, with_gains(posed, True))
    kept = [posed.library.hypotheses[i].place for own in found.local for i in own]
    assert ("viscous_friction", 1) in kept
    assert not any(name == "torque_gain" and joint != 1 for name, joint in kept)
