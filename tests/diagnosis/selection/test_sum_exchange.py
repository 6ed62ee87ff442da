"""A sum of laws gives way to a wider law beside the rest of it."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.selection.arm_search import views_of
from lagnet.diagnosis.selection.sum_exchange import exchange_sums, in_parts

SHARP = 1e-3  # [rad/s]


def number(view, name):
    library = view.equations.library
    own = [i for i in library.local[view.joint] if library.hypotheses[i].effect == name]
    return min(own, key=lambda i: library.hypotheses[i].shape)


@pytest.fixture(scope="module")
def as_on_real_joints(plant, arm, at):
    """Stribeck and viscous friction with an offset, as most real joints have them."""

    def torque(q, v, a, t):
        return (4.0 + 1.6 * np.exp(-((v / 0.1) ** 2))) * np.tanh(v / SHARP) + 1.6 * v - 0.4

    real = plant(at(1, torque))
    return pose(arm, real.record(61), real.record(62))


def test_stribeck_friction_beside_an_offset_is_no_drag(as_on_real_joints) -> None:
    """Unequal dry friction beside drag is the best that single exchanges reach: it holds the offset of the other."""
    equations, found = as_on_real_joints.equations, as_on_real_joints.search()
    hypotheses = equations.library.hypotheses
    assert {hypotheses[i].effect for i in found.local[1]} == {"asymmetric_friction", "quadratic_drag"}
    apart = exchange_sums(equations, found)
    assert {hypotheses[i].effect for i in apart.local[1]} == {"stribeck_friction", "viscous_friction", "torque_offset"}
    assert apart.score > found.score
    assert exchange_sums(equations, apart) is apart


def test_a_sum_is_taken_apart_for_a_wider_law_beside_the_rest_of_it(as_on_real_joints) -> None:
    view = views_of(as_on_real_joints.equations, as_on_real_joints.search())[1]
    uneven, drag, spring = (number(view, n) for n in ("asymmetric_friction", "quadratic_drag", "joint_spring"))
    hypotheses = view.equations.library.hypotheses
    found = [{hypotheses[i].effect for i in s} for s in in_parts(view, (uneven, drag))]
    assert {frozenset(s - {"quadratic_drag"}) for s in found} == {
        frozenset({wider, "torque_offset"}) for wider in ("stribeck_friction", "presliding_hysteresis")
    }
    assert in_parts(view, (uneven, spring)) == []  # a spring holds an offset already
    assert in_parts(view, (drag,)) == []
