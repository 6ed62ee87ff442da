"""Layers are identified once for each question, and a question is all that the answer follows from."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.diagnosis.identified.test_identify import posed
from tests.diagnosis.identified.test_recorded_scale import plant

import lagnet.diagnosis.identified.known_layers as known_layers
from lagnet.diagnosis.free_bodies import as_given, with_nominal
from lagnet.diagnosis.identified.fit import identify
from lagnet.diagnosis.identified.known_layers import KnownLayers
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.rigid_body.random_arm import random_arm

FRICTION = NamedEffect("viscous_friction", 1, {"Fv": 0.5})


@pytest.fixture(scope="module")
def problem():
    arm = random_arm(4, seed=5, kinds=("revolute",))
    return posed(arm, plant(arm, np.ones(4)), 12.0)


@pytest.fixture
def asked(monkeypatch) -> list[int]:
    """Numbers of effects of the questions that were answered anew."""
    questions: list[int] = []

    def counted(problem, effects):
        questions.append(len(effects))
        return None

    monkeypatch.setattr(known_layers, "identify", counted)
    return questions


def test_the_same_question_is_answered_once(problem, asked) -> None:
    layers = KnownLayers()
    heavier = problem.nominal.with_inertial_parameters(1.1 * problem.nominal.inertial_parameters())
    there_and_back = as_given(replace(with_nominal(problem, heavier), given=problem.nominal))
    for one in (problem, replace(problem, held=np.ones(4)), replace(problem, holdout=()), there_and_back):
        layers.beside(one, ())
    layers.beside(problem, (FRICTION,))
    layers.beside(problem, (replace(FRICTION),))
    assert asked == [0, 1]


def test_whatever_the_answer_follows_from_is_another_question(problem, asked) -> None:
    layers = KnownLayers()
    bodies = problem.nominal.inertial_parameters()
    fewer = tuple(p.with_counts(p.counts & (np.arange(len(p.counts)) % 2 == 0)[:, None]) for p in problem.fit)
    others = (
        problem,
        with_nominal(problem, problem.nominal.with_inertial_parameters(1.1 * bodies)),
        replace(problem, fit=fewer),
        replace(problem, fit=tuple(replace(p, tau=1.1 * p.tau) for p in problem.fit)),
        replace(problem, slow=2.0 * problem.slow),
    )
    for one in others:
        layers.beside(one, ())
    for held in (None, np.zeros(4)):
        layers.beside(replace(problem, held=held), (FRICTION,))
    assert asked == [0] * len(others) + [1, 1]


def test_friction_at_rest_matters_to_effects_alone(problem) -> None:
    free, held = (identify(replace(problem, held=h), ()) for h in (None, np.zeros(4)))
    assert free is not None
    assert held is not None
    np.testing.assert_array_equal(free.layer.bodies, held.layer.bodies)
    np.testing.assert_array_equal(free.layer.weights, held.layer.weights)
