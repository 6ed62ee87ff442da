"""A likeness of physics that is in no catalogue gets no name; the physics of the catalogue keeps its own beside it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.diagnosis.rules.cases import Bench

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.problem.problem import pose_problem
from lagnet.diagnosis.rules import surrogate_terms
from lagnet.diagnosis.rules.catalogue import RULES
from lagnet.effects.bristle import bristle
from lagnet.recordings.conditioning.condition import condition
from lagnet.rigid_body.random_arm import random_arm

ELABORATE = {"torque_gain", "link_inertia", "gravity_tilt", "payload", "load_dependent_friction", "quadratic_drag"}


def _elaborate(result) -> set[str]:
    return {e.effect for e in result.effects} & ELABORATE


@pytest.fixture(scope="module")
def pulled(plant):
    """An arm of which one joint is pulled by the angle of the next; its own weight looks much like it."""
    robot = random_arm(3, seed=14, kinds=("revolute",), fixed=False)
    pull = 0.3 * plant(robot=robot).usual_torque()[0]

    def by_another_angle(q, v, a, body):
        out = np.zeros_like(q)
        out[:, 0] = pull * (q[:, 1] - 0.3)
        return out

    arm = plant(by_another_angle, robot=robot)
    return [arm.record(1), arm.record(2)], robot, [arm.record(3)]


@pytest.fixture(scope="module")
def cubic(plant, at, arm):
    """Drag of the third power of speed."""
    made = plant(at(1, lambda q, v, a, t: 5.0 * v**3))
    return [made.record(1), made.record(2)], arm, [made.record(3)]


@pytest.mark.slow
def test_a_pull_by_another_joints_angle_is_no_error_of_weight(pulled) -> None:
    result = diagnose(*pulled)
    assert not _elaborate(result)
    assert result.verdict.unexplained[0].above_noise


@pytest.mark.slow
def test_a_cubic_drag_is_no_quadratic_one(cubic) -> None:
    result = diagnose(*cubic)
    assert not _elaborate(result)
    assert result.verdict.unexplained[1].above_noise


@pytest.mark.slow
def test_without_the_rule_a_cubic_drag_would_have_a_wrong_name(cubic) -> None:
    others = [r for r in RULES if r.name != surrogate_terms.SurrogateTerms.name]
    assert _elaborate(diagnose(*cubic, rules=others)) == {"quadratic_drag"}


@pytest.mark.slow
def test_a_true_name_beside_physics_without_one_is_kept(plant, at, arm, names) -> None:
    both = plant(
        at(1, lambda q, v, a, t: 5.0 * v * np.abs(v)),
        at(1, lambda q, v, a, t: 0.6 * q**2),
    )
    result = diagnose([both.record(4), both.record(5)], arm, [both.record(6)])
    assert ("quadratic_drag", arm.joints[1]) in names(result)


@pytest.fixture(scope="module")
def table(arm, plant):
    """Terms of the second joint on one recording, what is left of a torque beside the best three, and its segments."""
    given = condition([plant().record(1)])
    problem, own = pose_problem(arm, given, given), 1
    terms = surrogate_terms._terms(problem, problem.fit, own)

    def left(law) -> float:
        parts = [problem.reduce(p, law(p)[:, None])[:, 0] * p.counts[:, own] for p in problem.fit]
        wanted = np.concatenate(parts)
        chosen = terms[:, surrogate_terms._chosen(np.zeros((len(wanted), 0)), terms, wanted, 3)]
        rest = wanted - chosen @ np.linalg.lstsq(chosen, wanted, rcond=None)[0]
        return float(np.sum(rest**2) / np.sum(wanted**2))

    return problem, own, left


def test_a_cable_that_goes_taut_is_among_the_plain_terms(table) -> None:
    """Wherever it goes taut, between the angles that are tried too: three terms leave next to nothing of it."""
    problem, own, left = table
    tight, hard = np.quantile(np.concatenate([p.q[:, own] for p in problem.fit]), [0.56, 0.83])
    assert left(lambda p: np.maximum(p.q[:, own] - tight, 0.0) + 3.0 * np.maximum(p.q[:, own] - hard, 0.0)) < 0.01


def test_friction_that_changes_along_the_path_is_among_the_plain_terms(table) -> None:
    """Its mean is one of the terms: else they would replace no law that has this mean as well."""
    problem, own, left = table

    def worn(p):
        return (1.0 + 0.6 * np.sin(3.0 * p.q[:, own] + 0.4)) * np.tanh(p.v[:, own] / problem.slow[own])

    assert left(worn) < 0.01


@pytest.mark.parametrize(("fitted", "held_out", "asked"), [(0.2, 0.05, True), (0.05, 0.2, True), (0.05, 0.05, False)])
def test_a_joint_is_asked_that_is_unexplained_in_the_fit_or_held_out(fitted, held_out, asked) -> None:
    mismatch = np.random.default_rng(0).normal(size=(500, 1))
    sides = [[mismatch, share * mismatch] for share in (fitted, held_out)]
    assert surrogate_terms.SurrogateTerms()._is_unexplained(sides, 0, 1e-3, 1.0) == asked


@pytest.mark.parametrize(("fitted", "held_out", "asked"), [(2.0, 6.0, True), (6.0, 2.0, True), (6.0, 6.0, False)])
def test_an_effect_is_asked_that_explains_something_in_the_fit_or_held_out(fitted, held_out, asked) -> None:
    """Beside another effect that is larger by some factor; the effect is a term with an error."""

    def side(larger: float, seed: int):
        other, term, junk = np.random.default_rng(seed).normal(size=(3, 2000))
        names = np.column_stack([larger * other, term + 0.6 * junk])
        return surrogate_terms._Side(larger * other + term, names, np.column_stack([term, junk**2]), 1e-6)

    replaced = surrogate_terms.SurrogateTerms()._replaced(side(fitted, 1), side(held_out, 2), 1, 3)
    assert (replaced is not None) == asked


@pytest.fixture
def bristles(arm, plant, at):
    """Presliding friction fitted to a law of some joint."""
    size = 0.3 * plant().usual_torque()[1]

    def of(name: str, law):
        real = replace(plant(at(1, lambda q, v, a, body: size * law(q))), noise=0.001)
        return Bench(arm, plant, at, {}).candidate(name, real.record, ["presliding_hysteresis"])

    return of


def test_a_stiffening_spring_is_no_presliding_friction(bristles) -> None:
    hard = bristles("stiffening", lambda q: q**3)
    assert {r.effect for r in surrogate_terms.SurrogateTerms().rejected(hard)} == {"presliding_hysteresis"}


def test_presliding_friction_keeps_its_name(bristles) -> None:
    sticking = bristles("bristles", lambda q: bristle(q, 0.1))
    assert surrogate_terms.SurrogateTerms().rejected(sticking) == ()
