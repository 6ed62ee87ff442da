"""Learned and corrected models go through the same suite."""

from __future__ import annotations

import jax
import numpy as np
import pytest

from lagnet.models.corrected.model import CorrectedModel, NamedEffect
from lagnet.models.features import fit_features
from lagnet.models.kinds import ModelSpec, draw, settings_class
from lagnet.models.learned_model import LearnedModel
from lagnet.models.scales import fit_scales
from lagnet.plausibility.settings import CheckSettings
from lagnet.plausibility.suite import check
from lagnet.rigid_body.random_arm import random_arm

LIGHT = CheckSettings(samples=32, starts=1, iterations=2)


@pytest.fixture(scope="module")
def delan() -> LearnedModel:
    rng = np.random.default_rng(0)
    q, v, a = (rng.normal(size=(200, 2)) for _ in range(3))
    kinds = ("revolute", "continuous")
    spec = ModelSpec("delan", settings_class("delan")(), ("one", "two"), fit_features(q, kinds), fit_scales(v, a, a))
    return LearnedModel(spec, draw(spec, jax.random.key(0)))


@pytest.mark.slow
def test_structured_network_is_mechanics_but_untrained_it_is_another_arm(delan: LearnedModel):
    report = check(delan, random_arm(2, 3, ("revolute",)), settings=LIGHT)
    for name in ("mass_matrix_positive_definite", "coriolis_skew_symmetric", "energy_along_rollout", "periodic_joints"):
        assert report[name].status == "pass"
    failed = [c.name for c in report.failures]
    assert {"reference_inertial", "reference_gravity"} <= set(failed)
    assert all(name.startswith("reference_") for name in failed), report.headline()


@pytest.mark.slow
@pytest.mark.parametrize(("friction", "passes"), [(0.5, True), (-0.5, False)])
def test_corrected_model_is_judged_with_its_effects(friction: float, passes: bool):
    arm = random_arm(2, 3, ("revolute",))
    effects = (NamedEffect("viscous_friction", 1, {"Fv": friction}), NamedEffect("rotor_inertia", 0, {"Ia": 0.3}))
    report = check(CorrectedModel(arm, effects, np.full(2, 0.05)), settings=LIGHT)
    assert [c.name for c in report.failures] == ([] if passes else ["residual_dissipates"])
    assert report["link_mass"].status == "not_applicable", "the bodies are those of the nominal model"
