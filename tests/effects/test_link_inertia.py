"""A link whose mass alone is wrong: one number, in the ratio that its centre of mass and inertia give."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.effects.inertia.link_inertia import FREE, MASS, NAMES, LinkInertia, in_form, is_mass_alone, mass_alone
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.rigid_body.inertia import is_physically_consistent, tensor_about_com

LAW = LinkInertia()
JOINT, DM = 1, 0.3


@pytest.fixture
def link(ur5) -> np.ndarray:
    return ur5.inertial_parameters()[JOINT]


def test_another_mass_keeps_the_centre_and_the_inertia_about_it_or_that_per_mass(link) -> None:
    dense, alone = (link + LAW.body_parameters(LAW.values(np.array([DM / link[0]]), s)) for s in mass_alone(link))
    for body in (alone, dense):
        assert body[0] == pytest.approx(link[0] + DM)
        assert body[1:4] / body[0] == pytest.approx(link[1:4] / link[0])
        assert is_physically_consistent(body)
    assert tensor_about_com(alone) == pytest.approx(tensor_about_com(link), abs=1e-12)
    assert tensor_about_com(dense) == pytest.approx(tensor_about_com(link) * (1.0 + DM / link[0]))


def test_a_link_without_mass_has_no_centre_to_keep() -> None:
    assert mass_alone(np.zeros(10)) == ()


@pytest.mark.parametrize("n", [0, 1])
def test_one_column_is_the_torque_of_as_much_mass_again(ur5, sweep, link, n: int) -> None:
    motion, shape = sweep(ur5, 3).motion, mass_alone(link)[n]
    column = LAW.columns(motion, JOINT, shape)
    assert column.shape == (*motion.q.shape, 1)
    changed = ur5.with_inertial_parameters(
        ur5.inertial_parameters() + np.eye(ur5.n_dof)[[JOINT]].T * LAW.body_parameters(LAW.values(np.ones(1), shape))
    )
    added = changed.inverse_dynamics(motion.q, motion.v, motion.a) - motion.load
    assert column[..., 0] == pytest.approx(added, abs=1e-9)
    assert column @ np.array([DM]) == pytest.approx(LAW.torque(motion, JOINT, LAW.values(np.array([DM]), shape)))


def test_more_mass_than_a_link_has_cannot_be_missing(link) -> None:
    shape = mass_alone(link)[0]
    assert LAW.plausible(np.array([-0.9]), shape)
    assert not LAW.plausible(np.array([-1.1]), shape)


def test_its_mass_is_its_one_coordinate(link) -> None:
    effect = NamedEffect(LAW.name, JOINT, LAW.values(np.array([DM / link[0]]), mass_alone(link)[0]))
    assert effect.coordinates() == pytest.approx([DM])
    assert not effect.is_free_body
    assert [b.shape for b in effect.coordinate_bounds()] == [(1,), (1,)]
    twice = effect.at_coordinates(np.array([2.0 * DM]))
    assert is_mass_alone(twice.values)
    assert twice.body_parameters == pytest.approx(2.0 * effect.body_parameters)


def test_a_change_of_all_ten_has_ten_coordinates(link) -> None:
    effect = NamedEffect(LAW.name, JOINT, dict(zip(NAMES, 0.1 * link, strict=True)))  # as a file without a form has it
    assert effect.is_free_body
    assert effect.coordinates() == pytest.approx(0.1 * link)
    assert LAW.with_names_of_today(effect.values)["form"] == FREE
    assert in_form(np.eye(10), effect.values) == pytest.approx(np.eye(10))
    assert LAW.remark({**effect.values, "form": FREE}) != LAW.remark({**effect.values, "form": MASS})
