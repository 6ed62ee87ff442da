"""What friction does where it turns is no delay and no rotor; a delay and a rotor beside friction are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from tests.diagnosis.rules.cases import Bench

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.rules.reversals_only import ReversalsOnly, acts_throughout
from lagnet.effects.catalogue import CATALOGUE
from lagnet.models.corrected.named_effects import NamedEffect

JOINT = 1
LEAD = 0.012  # [s] by which dry friction turns before the speed


@pytest.fixture
def rubbing(plant, at):
    """A plant with dry friction that turns some time before the speed does."""

    def of(lead: float):
        size = plant().usual_torque()[JOINT]
        return replace(plant(at(JOINT, lambda q, v, a, body: size * np.tanh((v + lead * a) / 0.05))), noise=0.001)

    return of


def test_friction_that_turns_early_is_friction_alone(rubbing, arm, names) -> None:
    real = rubbing(LEAD)
    result = diagnose([real.record(seed) for seed in (1, 2, 3)], arm, [real.record(4)])
    assert names(result) == {("coulomb_friction", arm.joints[JOINT])}


def test_a_delay_beside_friction_keeps_its_name(rubbing, arm, names) -> None:
    real = rubbing(0.0)

    def late(seed: int):
        one = real.record(seed)
        tau = np.array(one.tau)
        tau[:, JOINT] = CubicSpline(one.time, tau[:, JOINT])(np.maximum(one.time - 2.0 * LEAD, 0.0))
        return replace(one, tau=tau)

    result = diagnose([late(seed) for seed in (1, 2, 3)], arm, [late(4)])
    assert names(result) == {("coulomb_friction", arm.joints[JOINT]), ("time_delay", arm.joints[JOINT])}


@pytest.fixture(scope="module")
def starting(arm, plant, at):
    """Dry friction with a further torque that grows with acceleration, at all speeds or near zero speed alone."""
    bench = Bench(arm, plant, at, {})
    size = 0.2 * plant().usual_torque()[JOINT]

    def of(name: str, until: float):
        def law(q, v, a, body):
            return size * (np.tanh(v / 1e-3) + 0.2 * a * np.exp(-((v / until) ** 2)))

        return bench.of(name, law, "coulomb_friction", "rotor_inertia")

    return of


def test_a_rotor_that_helps_where_friction_starts_alone_is_none(starting) -> None:
    (rejected,) = ReversalsOnly().rejected(starting("near zero speed", 0.05))
    assert (rejected.effect, rejected.joint) == ("rotor_inertia", JOINT)
    assert rejected.value < 1.0


def test_a_rotor_beside_dry_friction_keeps_its_name(starting) -> None:
    assert ReversalsOnly().rejected(starting("throughout", 1e6)) == ()


def test_what_acts_where_a_joint_turns_is_not_asked() -> None:
    asked = {name for name in CATALOGUE if acts_throughout(NamedEffect(name, 0, {}))}
    assert {"rotor_inertia", "time_delay", "viscous_friction", "torque_gain"} <= asked
    assert not asked & {"coulomb_friction", "presliding_hysteresis", "backlash", "joint_elasticity", "saturation"}
