"""Evidence of one joint's selections: what may stand together, and all additions at once as one by one."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.selection.arm_search import views_of
from lagnet.diagnosis.selection.joint_view import compatible

SHARP = 1e-3  # [rad/s]


def view_of(plant, arm, at, torque):
    real = plant(at(1, torque))
    posed = pose(arm, real.record(43), real.record(44))
    return views_of(posed.equations, posed.search())[1]


@pytest.fixture(scope="module")
def view(plant, arm, at):
    return view_of(plant, arm, at, lambda q, v, a, t: 2.0 * np.tanh(v / SHARP) + 3.0 * v)


def numbers(view, name):
    """Hypotheses of an effect, by their shapes."""
    library = view.equations.library
    own = [i for i in library.local[view.joint] if library.hypotheses[i].effect == name]
    return sorted(own, key=lambda i: library.hypotheses[i].shape)


@pytest.mark.parametrize("names", [(), ("coulomb_friction",), ("viscous_friction", "coulomb_friction")])
def test_all_additions_at_once_have_the_evidence_of_each(view, names) -> None:
    selection = tuple(numbers(view, name)[0] for name in names)
    scores = view.scores_with_each(selection)
    for k, found in zip(view.equations.library.local[view.joint], scores, strict=True):
        if k in selection or not compatible(view, selection, k):
            assert found == -np.inf
        else:
            assert found == pytest.approx(view.score((*selection, k)), rel=1e-6)


def test_the_evidence_follows_no_order(view) -> None:
    one, other = numbers(view, "coulomb_friction")[0], numbers(view, "viscous_friction")[0]
    assert view.score((one, other)) == pytest.approx(view.score((other, one)), rel=1e-12)
    np.testing.assert_array_equal(view.scores_with_each((one, other)), view.scores_with_each((other, one)))


def test_a_law_never_stands_beside_its_special_case_nor_twice(view) -> None:
    coulomb, stribeck = numbers(view, "coulomb_friction")[0], numbers(view, "stribeck_friction")
    assert not compatible(view, (coulomb,), stribeck[0])
    assert not compatible(view, (coulomb,), numbers(view, "asymmetric_friction")[0])
    assert stribeck[0] != stribeck[-1]
    assert not compatible(view, (stribeck[0],), stribeck[-1])


def test_friction_that_drives_has_no_evidence(plant, arm, at) -> None:
    view = view_of(plant, arm, at, lambda q, v, a, t: -2.0 * v)
    assert view.score((numbers(view, "viscous_friction")[0],)) == -np.inf
