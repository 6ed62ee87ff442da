"""The search names what is there, nothing beside it, and the plainer of two laws that say the same."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.selection.arm_search import views_of
from lagnet.diagnosis.selection.joint_search import drop_immaterial, improve, simplify

SHARP = 1e-3  # [rad/s]


@pytest.fixture(scope="module")
def posed(plant, arm, at):
    real = plant(at(1, lambda q, v, a, t: 2.0 * np.tanh(v / SHARP) + 3.0 * v))
    return pose(arm, real.record(41), real.record(42))


@pytest.fixture(scope="module")
def view(posed):
    return views_of(posed.equations, posed.search())[1]


def number(view, name, least=True):
    library = view.equations.library
    own = [i for i in library.local[view.joint] if library.hypotheses[i].effect == name]
    return min(own, key=lambda i: library.hypotheses[i].shape) if least else own[-1]


def test_the_search_finds_both_laws_and_no_other(posed) -> None:
    found = posed.search()
    chosen = {posed.library.hypotheses[i].place for i in found.indices}
    assert chosen == {("coulomb_friction", 1), ("viscous_friction", 1)}


def test_improving_is_never_worse_and_finds_the_same_from_a_wrong_start(view) -> None:
    wrong = (number(view, "joint_spring"), number(view, "rotor_inertia"))
    best = improve(view, wrong)
    assert view.score(best) > view.score(wrong)
    assert {view.equations.library.hypotheses[i].effect for i in best} == {"coulomb_friction", "viscous_friction"}


def test_a_wider_law_at_its_least_shape_gives_way_to_its_special_case(view) -> None:
    stribeck, viscous = number(view, "stribeck_friction"), number(view, "viscous_friction")
    names = {view.equations.library.hypotheses[i].effect for i in simplify(view, (stribeck, viscous))}
    assert names == {"coulomb_friction", "viscous_friction"}


def test_what_takes_nothing_off_the_error_is_dropped(view) -> None:
    true = (number(view, "coulomb_friction"), number(view, "viscous_friction"))
    assert set(drop_immaterial(view, (*true, number(view, "rotor_inertia")))) == set(true)


def test_a_small_stribeck_curve_behind_a_large_spring_is_no_coulomb_friction(plant, arm, at) -> None:
    def torque(q, v, a, t):
        return 60.0 * q + (1.0 + 1.0 * np.exp(-((v / 0.25) ** 2))) * np.tanh(v / SHARP)

    real = plant(at(1, torque))
    posed = pose(arm, real.record(43), real.record(44))
    chosen = {posed.library.hypotheses[i].place for i in posed.search().indices}
    assert chosen == {("joint_spring", 1), ("stribeck_friction", 1)}


def test_a_spring_far_from_its_rest_position_is_no_torque_offset(plant, arm, at) -> None:
    real = plant(at(2, lambda q, v, a, t: 5.0 * (q + 30.0)))
    posed = pose(arm, real.record(45), real.record(46))
    view = views_of(posed.equations, posed.search())[2]
    assert simplify(view, (number(view, "joint_spring"),)) == (number(view, "joint_spring"),)
