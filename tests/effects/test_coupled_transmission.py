"""A coupled motor's ratio is proposed from what is left at both joints, where plus and minus one leave more."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.effects.catalogue import CATALOGUE

LAW = CATALOGUE["coupled_transmission"]
JOINT, NEAR = 3, 0.03  # of the ratio: the refit finds its way from there
DRAG = {"Fv": 0.5, "Fc": 2.0, "Ia": 0.05}


def left(sweep, ur5, ratio: float, noise: float = 0.05):
    """Motion and what a motor of a ratio leaves beside friction of the joints' own, which a selection has taken."""
    motion = sweep(ur5, 4).motion
    torque = LAW.torque(motion, JOINT, DRAG | {"ratio": ratio})
    torque[:, JOINT] -= 1.5 * np.tanh(motion.v[:, JOINT] / motion.slow[JOINT])
    return motion, torque + np.random.default_rng(0).normal(scale=noise, size=torque.shape)


@pytest.mark.parametrize("ratio", [2.2, 0.45, -1.6, -0.6])
def test_another_ratio_is_proposed(sweep, ur5, ratio: float) -> None:
    ((proposed,),) = (tuple(shape.values()) for shape in LAW.proposals(*_args(sweep, ur5, ratio)))
    assert proposed == pytest.approx(ratio, rel=NEAR)


@pytest.mark.parametrize("ratio", [1.0, -1.0])
def test_plain_ratios_are_tried_without_and_not_proposed(sweep, ur5, ratio: float) -> None:
    assert LAW.proposals(*_args(sweep, ur5, ratio)) == ()
    assert {"ratio": ratio} in LAW.shapes(sweep(ur5, 4).motion, JOINT)


def test_noise_proposes_none(sweep, ur5) -> None:
    motion = sweep(ur5, 4).motion
    rest = np.random.default_rng(1).normal(size=motion.q.shape)
    assert all(LAW.proposals(motion, joint, rest) == () for joint in range(1, 6))
    assert LAW.proposals(motion, 0, rest) == ()


@pytest.mark.parametrize(
    ("drag", "plausible"),
    [
        ((0.5, 2.0, 0.05), True),
        ((0.0, 2.0, 0.0), True),  # dry friction alone
        ((-0.1, 2.0, 0.0), False),
        ((0.5, -0.1, 0.0), False),
        ((0.5, 0.0, 0.05), False),
        ((0.5, 2.0, -0.05), False),
    ],
)
def test_friction_dissipates_and_a_rotor_has_inertia(drag, plausible: bool) -> None:
    assert LAW.plausible(np.array(drag), {"ratio": 1.7}) == plausible


@pytest.mark.parametrize(("ratio", "plain"), [(2.2, 1.0), (0.3, 1.0), (-1.1, -1.0), (1.0, None), (-1.0, None)])
def test_a_ratio_of_one_is_the_special_case(ratio: float, plain: float | None) -> None:
    assert LAW.special_case({"ratio": ratio}) == (None if plain is None else {"ratio": plain})


def _args(sweep, ur5, ratio: float):
    motion, rest = left(sweep, ur5, ratio)
    return motion, JOINT, rest
