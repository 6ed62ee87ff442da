"""Physics in no catalogue gets no name, but its shape, and a formula where it is simple."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.unexplained.formula import find_shape
from lagnet.diagnosis.unexplained.predictability import signals_of


@pytest.fixture(scope="module")
def posed(plant, arm):
    problem = pose(arm, plant().record(101), plant().record(102)).problem
    return (signals_of(problem, problem.fit), signals_of(problem, problem.holdout)), problem.slow


def shape_of(posed, law, depends_on):
    signals, slow = posed
    rng = np.random.default_rng(2)
    residuals = tuple(law(s.of) + 0.02 * rng.standard_normal(len(s.table)) for s in signals)
    return find_shape(signals, residuals, depends_on, slow)


SIMPLE = {
    "product": (lambda of: 1.5 * of("v_0") * of("v_1"), ("v_1", "v_0"), "1.5 v_1·v_0"),
    "cubic": (lambda of: 0.8 * of("v_2") ** 3, ("v_2",), "0.8 v_2³"),
    "wave": (lambda of: 2.0 * np.sin(2.0 * of("q_1")), ("q_1",), "2 sin(2q_1)"),
    "friction by pose": (lambda of: np.sign(of("v_1")) * of("q_1"), ("v_1", "q_1"), "sign(v_1)·q_1"),
}


@pytest.mark.parametrize("name", SIMPLE)
def test_a_simple_law_is_written_down(posed, name) -> None:
    law, depends_on, expected = SIMPLE[name]
    shape = shape_of(posed, law, depends_on)
    assert shape.formula is not None
    assert expected.split(" ")[-1] in shape.formula
    assert shape.share > 0.8
    assert shape.signal == depends_on[0]


def test_noise_has_no_formula(posed) -> None:
    shape = shape_of(posed, lambda of: 0.0 * of("v_0"), ("v_0",))
    assert shape.formula is None
    assert shape.share < 0.1


def test_the_curve_follows_the_residual(posed) -> None:
    shape = shape_of(posed, lambda of: 2.0 * of("q_0"), ("q_0",))
    np.testing.assert_allclose(shape.curve[:, 1], 2.0 * shape.curve[:, 0], atol=0.1)


@pytest.mark.slow
def test_unlisted_physics_is_told_with_its_signals(plant, arm) -> None:
    def dragged(q, v, a, body):  # joint 1 feels the speed of joint 2, which no law of the catalogue does
        out = np.zeros_like(q)
        out[:, 1] = 3.0 * v[:, 2] * np.abs(v[:, 2])
        return out

    real = plant(dragged)
    result = diagnose([real.record(s) for s in (111, 112)], arm, [real.record(113)])
    assert not [e for e in result.effects if e.joint == arm.joints[1]]
    left = result.verdict.unexplained[1]
    assert left.above_noise
    assert "v_2" in left.depends_on
    assert left.formula is not None
    assert "v_2" in left.formula
    assert result.evidence.of(arm.joints[1]).predictable_share > 0.5
