"""A link's mass in the place of ten parameters of it, where the evidence prefers one number."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.regression.block_gram import collect_block_grams
from lagnet.diagnosis.selection.arm_search import refit_selection
from lagnet.diagnosis.selection.link_exchange import exchange_links
from lagnet.rigid_body.inertia import parameters_of_body, tensor_about_com

LINK = "link_inertia"
RIGHT = 0.05


def changed(arm, link: int, mass: float = 1.0, inertia: float = 1.0, shift=(0.0, 0.0, 0.0)):
    """The arm with another mass, inertia about the centre (factors) and centre of mass [m] of a link."""
    bodies = arm.inertial_parameters()
    m, centre = bodies[link, 0], bodies[link, 1:4] / bodies[link, 0]
    tensor = tensor_about_com(bodies[link])
    bodies[link] = parameters_of_body(mass * m, centre + np.array(shift), inertia * tensor)
    return arm.with_inertial_parameters(bodies)


def missing_mass(arm, link: int, factor: float) -> float:
    return (factor - 1.0) * arm.inertial_parameters()[link, 0]


@pytest.fixture
def link_effect(plant, arm):
    """The one effect that is named where a link differs."""

    def named(**difference):
        real = plant(robot=changed(arm, **difference))
        (found,) = diagnose([real.record(1), real.record(2)], arm, [real.record(3)]).effects
        assert found.effect == LINK
        assert ("the mass alone" in found.explanation) == ("dmcx" not in found.explanation)
        return found.joint, {p.name: p for p in found.parameters}

    return named


@pytest.mark.parametrize("inertia", [1.0, 1.3])
@pytest.mark.parametrize("link", [0, 1])
def test_another_mass_is_one_number(link_effect, arm, link: int, inertia: float) -> None:
    joint, found = link_effect(link=link, mass=1.3, inertia=inertia)
    assert joint == arm.joints[link]
    assert found["form"].value == 1.0
    assert found["dm"].value == pytest.approx(missing_mass(arm, link, 1.3), rel=RIGHT)
    assert found["dm"].ci95[0] <= missing_mass(arm, link, 1.3) <= found["dm"].ci95[1]


def test_a_lighter_link_is_one_number(link_effect, arm) -> None:
    _, found = link_effect(link=1, mass=0.75, inertia=0.75)
    assert found["form"].value == 1.0
    assert found["dm"].value == pytest.approx(missing_mass(arm, 1, 0.75), rel=RIGHT)


@pytest.mark.parametrize("link", [0, 1])
def test_under_noise_it_is_tied_with_no_law_that_is_made_of_noise(plant, arm, link: int) -> None:
    real = replace(plant(robot=changed(arm, link, mass=1.15)), noise=0.1)
    (found,) = diagnose([real.record(1), real.record(2)], arm, [real.record(3)]).effects
    assert (found.effect, found.joint, found.tied_with) == (LINK, arm.joints[link], ())
    assert found.parameters[0].value == pytest.approx(missing_mass(arm, link, 1.15), rel=0.2)


def test_another_centre_of_mass_leaves_all_ten_free(link_effect) -> None:
    _, found = link_effect(link=1, mass=1.3, shift=(0.03, -0.02, 0.02))
    assert found["form"].value == 0.0


def test_what_is_no_link_is_left_as_it_is(plant, arm, at) -> None:
    real = plant(at(1, lambda q, v, a, load: 3.0 * v))
    posed = pose(arm, real.record(1), real.record(2))
    found = posed.select({1: ["viscous_friction"]})
    assert exchange_links(posed.problem, posed.equations, found) == (posed.equations, found)


def test_ten_parameters_of_a_link_give_way_to_the_mass_of_the_link_that_differs(plant, arm) -> None:
    real = plant(robot=changed(arm, 1, mass=1.3))
    posed = pose(arm, real.record(1), real.record(2))
    neighbour = replace(posed.select({}), arm_wide=(posed.index(LINK, 0),))
    free = refit_selection(posed.equations, neighbour)
    equations, found = exchange_links(posed.problem, posed.equations, free)
    assert len(equations.library.hypotheses) == len(posed.library.hypotheses) + 1
    (chosen,) = found.arm_wide
    assert equations.library.hypotheses[chosen].place == (LINK, 1)
    assert equations.library.widths[chosen] == 1
    assert found.score > free.score


def test_normal_equations_with_a_mass_are_those_of_its_column(plant, arm) -> None:
    real = plant(robot=changed(arm, 1, mass=1.3))
    posed = pose(arm, real.record(1), real.record(2))
    free = refit_selection(posed.equations, replace(posed.select({}), arm_wide=(posed.index(LINK, 1),)))
    equations, _ = exchange_links(posed.problem, posed.equations, free)
    fresh = collect_block_grams(posed.problem, equations.library, posed.problem.fit)
    for summed, made in zip(equations.grams.joints, fresh.joints, strict=True):
        assert summed == pytest.approx(made, rel=1e-6, abs=1e-6 * np.abs(made).max())
