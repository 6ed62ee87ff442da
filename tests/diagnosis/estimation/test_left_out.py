"""What a fit leaves without one effect follows the exact fit of the others, to first order in their parameters."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.estimation.gauss_newton import start_gauss_newton
from lagnet.diagnosis.estimation.left_out import LeftOut
from lagnet.diagnosis.estimation.refit import refit
from lagnet.models.corrected.named_effects import NamedEffect

JOINT = 1
ROTOR, DAMPING, OFFSET = 0.5, 2.0, 1.0


@pytest.fixture(scope="module")
def posed(plant, arm, at):
    """A joint with a rotor, viscous friction and an offset that the model lacks."""
    real = plant(at(JOINT, lambda q, v, a, body: ROTOR * a + DAMPING * v + OFFSET))
    return pose(arm, real.record(71), real.record(72))


@pytest.fixture(scope="module")
def effects(posed):
    """The three effects as they are fitted together."""
    start = [
        NamedEffect("rotor_inertia", JOINT, {"Ia": 0.1}),
        NamedEffect("viscous_friction", JOINT, {"Fv": 0.1}),
        NamedEffect("torque_offset", JOINT, {"b": 0.1}),
    ]
    return refit(posed.problem, start, posed.noise).effects


def left(problem, effects, sigma) -> list[np.ndarray]:
    """Residuals of a fit by the exact laws."""
    work, x = start_gauss_newton(problem, refit(problem, effects, sigma).effects, sigma)
    return work.residuals(x)


@pytest.mark.parametrize("n", range(3))
def test_of_linear_laws_it_is_the_exact_fit_of_the_others(posed, effects, n) -> None:
    others = [e for k, e in enumerate(effects) if k != n]
    for found, exact in zip(
        LeftOut(posed.problem, effects, posed.noise).without(n), left(posed.problem, others, posed.noise), strict=True
    ):
        assert np.std(exact) > 2.0
        assert found == pytest.approx(exact, abs=1e-3 * np.abs(exact).max())


def test_residuals_with_all_effects_are_those_of_the_fit(posed, effects) -> None:
    for found, exact in zip(
        LeftOut(posed.problem, effects, posed.noise).residuals, left(posed.problem, effects, posed.noise), strict=True
    ):
        assert found == pytest.approx(exact, abs=1e-6 * np.abs(exact).max())


def test_an_effect_that_stands_alone_leaves_the_nominal_model(posed, effects) -> None:
    (nominal,) = LeftOut(posed.problem, effects[:1], posed.noise).without(0)
    (piece,) = posed.problem.fit
    assert nominal == pytest.approx(posed.problem.residual(piece) * piece.counts / posed.noise, abs=1e-9)
