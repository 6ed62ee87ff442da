"""Friction of the identified layer takes work from its joint, unless a model or a name has more than the joint's."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lagnet.diagnosis.identified.design import Design, Group, JointRows
from lagnet.diagnosis.identified.friction.dissipation import DRIVES, driving_friction, with_friction
from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.corrected.motion_terms import MotionTerm
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.rigid_body.random_arm import random_arm

VISCOUS, DRY, OFFSET = range(3)
KINDS = ("viscous", "dry", "offset")


def joint(weights: tuple[float, float, float], spread: float = 1.0) -> tuple[Design, Any]:
    """One joint whose speed goes back and forth, or nearly one way, and the solution with these weights."""
    v = np.sin(np.linspace(0.0, 20.0, 400)) + (1.0 - spread)
    columns = np.column_stack([v, np.sign(v), np.ones_like(v)])
    scale = np.sqrt(np.mean(columns**2, axis=0))
    rows = JointRows(columns / scale, columns @ weights, np.ones(v.size, bool), np.arange(3))
    terms = tuple(MotionTerm(kind, 0) for kind in KINDS)
    design = Design((rows,), (Group("core", np.arange(3), True, 0),), terms, 0, scale, np.zeros(v.size, int))
    return design, SimpleNamespace(ridge=SimpleNamespace(x=np.array(weights) * scale))


@pytest.mark.parametrize(
    ("weights", "gone"),
    [
        pytest.param((1.0, 2.0, 0.0), [], id="friction"),
        pytest.param((1.0, -2.0, 3.0), [DRY], id="dry friction that drives"),
        pytest.param((-2.0, 1.0, 0.0), [VISCOUS], id="viscous friction that drives"),
        pytest.param((-0.5, 2.0, 0.0), [], id="less at speed, and still friction"),
        pytest.param((0.0, -0.2 * DRIVES, 1.0), [], id="next to nothing"),
        pytest.param((0.0, 0.0, -9.0), [], id="an offset"),
    ],
)
def test_friction_that_gives_work_is_none(weights, gone) -> None:
    assert driving_friction(*joint(weights), spared=()).tolist() == gone
    assert driving_friction(*joint(weights), spared={0}).tolist() == []


def test_friction_that_an_offset_cancels_is_none_where_a_joint_turns_one_way() -> None:
    assert driving_friction(*joint((8.0, -56.0, 64.0), spread=0.1), spared=()).tolist() == [DRY]


@pytest.mark.parametrize(("bristle", "gone"), [(0.5, [DRY]), (-0.5, [DRY, OFFSET])], ids=["stiff", "less than none"])
def test_bristles_that_give_back_what_they_took_stay(bristle: float, gone: list[int]) -> None:
    """A bristle whose work over these samples is negative for a positive stiffness, beside dry friction that drives."""
    design, _ = joint((0.0, -2.0, bristle))
    rows, v = design.joints[0], design.joints[0].columns[:, VISCOUS]
    rows.columns[:, OFFSET] = -np.sign(bristle) * v
    terms = (*design.terms[:OFFSET], MotionTerm("bristle", 0, 0.01))
    found: Any = SimpleNamespace(ridge=SimpleNamespace(x=np.array([0.0, -2.0, bristle])))
    assert driving_friction(replace(design, terms=terms), found, spared=()).tolist() == gone


def test_a_joint_is_not_asked_whose_friction_is_modelled_or_named() -> None:
    arm = random_arm(3, seed=1)
    named = (NamedEffect("viscous_friction", 1, {"Fv": 2.0}), NamedEffect("torque_offset", 2, {"b": 1.0}))
    problem: Any = SimpleNamespace(nominal=arm, n_dof=3)
    assert with_friction(problem, ()) == set()
    assert with_friction(problem, named) == {1}
    problem.nominal = CorrectedModel(arm, named, np.ones(3))
    assert with_friction(problem, ()) == {0, 1, 2}
    problem.nominal = object()  # a learned one, whose friction is in its torque
    assert with_friction(problem, ()) == {0, 1, 2}
