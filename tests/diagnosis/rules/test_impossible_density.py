"""A link that matter could not make is no link."""

from __future__ import annotations

from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from lagnet.diagnosis.estimation.nearest_body import nearest_body
from lagnet.diagnosis.rules.candidate import Candidate
from lagnet.diagnosis.rules.impossible_density import ImpossibleDensity
from lagnet.diagnosis.rules.rule import Rejection
from lagnet.effects.catalogue import effect_named
from lagnet.models.corrected.model import NamedEffect
from lagnet.rigid_body.inertia import is_physically_consistent, least_density, parameters_of_body


def link_change(change: np.ndarray) -> NamedEffect:
    return NamedEffect("link_inertia", 1, effect_named("link_inertia").from_coordinates(change))


@pytest.fixture
def link(arm) -> np.ndarray:
    return np.asarray(arm.inertial_parameters())[1]


@pytest.fixture
def rejected(arm):
    """Rejections of a change of the second link."""
    library = SimpleNamespace(hypotheses={7: SimpleNamespace(effect="link_inertia", joint=1)})

    def judged(change: np.ndarray) -> tuple[Rejection, ...]:
        problem = SimpleNamespace(nominal=arm)
        candidate = SimpleNamespace(problem=problem, library=library, indices=(7,), effects=(link_change(change),))
        return ImpossibleDensity().rejected(cast(Candidate, candidate))

    return judged


def test_much_mass_beside_the_axis_is_no_body(rejected, link) -> None:
    change = np.zeros(10)
    change[0] = 5000.0 * link[0]
    (one,) = rejected(change)
    assert one.index == 7
    assert one.value > one.limit == ImpossibleDensity().most_density


def test_a_tool_bolted_to_a_link_is_a_body(rejected) -> None:
    steel = parameters_of_body(8.0, np.array([0.1, 0.05, 0.0]), 0.4 * 8.0 * 0.06**2 * np.eye(3))
    assert not rejected(steel)


def test_what_noise_leaves_open_asks_for_no_heavy_body(link) -> None:
    """A first moment that is well known and a rotational inertia that is not: mass alone could make up for that."""
    wanted = link.copy()
    wanted[1:4] *= 3.0
    wanted[4:] *= 0.5
    gram = np.diag([1e-9, *[1e8] * 3, *[1e-3] * 6])
    body = nearest_body(gram, wanted, link)
    assert is_physically_consistent(body)
    np.testing.assert_allclose(body[1:4], wanted[1:4], atol=1e-3)
    assert body[0] < 5.0 * link[0]
    assert least_density(body) < 20.0 * least_density(link)
