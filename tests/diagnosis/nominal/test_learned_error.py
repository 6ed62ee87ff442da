"""A network is wrong where its training did not lead: its error gets no name, friction beside it does."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.posed import pose

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.nominal.learned_error import may_be_its_error
from lagnet.diagnosis.rules.lack_of_fit import LackOfFit, outshines
from lagnet.diagnosis.selection.holdout_gain import HoldoutGain
from lagnet.models.corrected.model import NamedEffect

OFFSET = np.array([0.0, 0.0, 0.25])  # [rad] by which the model's poses are off
WAVES = 0.15  # of a joint's usual torque


class Learned:
    """What a network may have learned of an arm: its torque in a pose that is a little off, and waves beside it."""

    def __init__(self, arm, usual: np.ndarray, model_kind: str | None):
        self.arm, self.usual, self.model_kind = arm, usual, model_kind
        self.joints, self.n_dof, self.joint_types = arm.joints, arm.n_dof, arm.joint_types

    def inverse_dynamics(self, q, v, a):
        waves = np.sin(2.0 * q[:, [1]] + 5.0 * q[:, [2]] + np.arange(3))
        return self.arm.inverse_dynamics(q + OFFSET, v, a) + WAVES * self.usual * waves

    def mass_matrix(self, q):
        return self.arm.mass_matrix(q + OFFSET)

    def coriolis_torque(self, q, v):
        return self.inverse_dynamics(q, v, 0 * v) - self.gravity_torque(q)

    def gravity_torque(self, q):
        return self.inverse_dynamics(q, 0 * q, 0 * q)


@pytest.fixture
def learned(arm, plant):
    return lambda kind: Learned(arm, plant().usual_torque(), kind)


@pytest.mark.slow
def test_friction_is_named_beside_the_error_of_a_network(plant, at, arm, learned, names) -> None:
    real = plant(at(0, lambda q, v, a, body: 0.3 * np.abs(body).mean() * v))
    fitted, held = [real.record(seed, seconds=16.0) for seed in (1, 2)], [real.record(4, seconds=16.0)]
    assert names(diagnose(fitted, learned("delan"), held, bandwidth=6.0)) == {("viscous_friction", arm.joints[0])}


@pytest.mark.parametrize(("share", "stands"), [(0.9, True), (0.5, False)])
def test_what_may_be_an_error_stands_only_far_above_what_is_left_where_it_does_most(share, stands) -> None:
    part = HoldoutGain(1.0, 0.1, share, (0, 1), np.array([share, 0.02, 0.0]))
    assert outshines(part, LackOfFit().stands, {0: 0.06}, {0: 0.08, 1: 0.9}) == stands


EFFECTS = (
    NamedEffect("viscous_friction", 0, {"Fv": 1.0}),
    NamedEffect("coulomb_friction", 1, {"Fc": 1.0}),
    NamedEffect("encoder_offset", 1, {"delta": 0.05}),
    NamedEffect("joint_spring", 2, {"k": 2.0, "q0": 0.1}),
    NamedEffect("rotor_inertia", 0, {"Ia": 0.2}),
    NamedEffect("time_delay", 0, {"T": 0.01}),
)
SMOOTH = {("encoder_offset", 1), ("joint_spring", 2), ("rotor_inertia", 0)}
DOUBTFUL = {
    "delan": SMOOTH,
    "delan-blackbox": SMOOTH,
    "ffnn": {(e.effect, e.joint) for e in EFFECTS},
    "serial-chain": set(),
    None: set(),
}


@pytest.mark.parametrize("kind", DOUBTFUL)
def test_what_looks_the_same_backwards_may_be_the_error_of_a_lagrangian(plant, learned, kind) -> None:
    problem = pose(learned(kind), plant().record(81), plant().record(82)).problem
    assert may_be_its_error(problem, EFFECTS) == DOUBTFUL[kind]
