"""A model that compiles is asked for few shapes and not too often: what a check costs, told without a clock."""

from __future__ import annotations

from collections import Counter

import jax
import numpy as np
import pytest

from lagnet.models.features import fit_features
from lagnet.models.kinds import ModelSpec, draw, settings_class
from lagnet.models.learned_model import LearnedModel
from lagnet.models.scales import fit_scales
from lagnet.plausibility.calling import BATCH, BATCH_OF
from lagnet.plausibility.settings import CheckSettings
from lagnet.plausibility.suite import check
from lagnet.rigid_body.robot import load_description

CALLS = ("inverse_dynamics", "mass_matrix", "coriolis_torque", "gravity_torque", "forward_dynamics", "residual_torque")
LIGHT = CheckSettings(samples=48, starts=1, iterations=3)
MOST_BATCHES = 20_000  # of a seven-joint arm; a batch takes a learned model 0.2 to 1 ms


class Compiling:
    """A model that says that it compiles, and counts the shapes that it is asked for."""

    def __init__(self, model):
        self.joints, self.n_dof, self.joint_types = model.joints, model.n_dof, model.joint_types
        self.compiles = getattr(model, "compiles", True)
        self.batches: dict[str, Counter[int]] = {}
        for name in CALLS:
            if hasattr(model, name):
                setattr(self, name, self._counted(name, getattr(model, name)))

    def _counted(self, name, call):
        rows = self.batches.setdefault(name, Counter())

        def counted(*arrays):
            rows[len(arrays[0])] += 1
            return call(*arrays)

        return counted


def assert_one_shape_a_call(model: Compiling):
    assert model.batches["inverse_dynamics"]
    for name, rows in model.batches.items():
        assert set(rows) <= {BATCH_OF.get(name, BATCH)}, name


def test_one_shape_a_call_for_model_and_reference():
    arm = load_description("ur5")
    model, reference = Compiling(arm), Compiling(arm)
    assert check(model, reference, settings=LIGHT).passed
    assert_one_shape_a_call(model)
    assert_one_shape_a_call(reference)


@pytest.mark.slow
def test_full_effort_on_seven_joints_is_bounded():
    model = Compiling(load_description("panda"))
    assert check(model).passed
    assert sum(sum(rows.values()) for rows in model.batches.values()) < MOST_BATCHES


@pytest.mark.slow
def test_learned_model_sees_one_shape_a_call_even_after_it_was_used():
    rng = np.random.default_rng(0)
    q, v, a = (rng.normal(size=(200, 2)) for _ in range(3))
    features, scales = fit_features(q, ("revolute",) * 2), fit_scales(v, a, a)
    spec = ModelSpec("delan-ffnn", settings_class("delan-ffnn")(), ("one", "two"), features, scales)
    model = LearnedModel(spec, draw(spec, jax.random.key(0)))
    model.inverse_dynamics(q[:BATCH], v[:BATCH], a[:BATCH])
    watched = Compiling(model)
    check(watched, settings=LIGHT)
    assert_one_shape_a_call(watched)
