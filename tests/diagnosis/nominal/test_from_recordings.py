"""The simulator's arm from its log, whether its joints have friction or none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.nominal import from_recordings as from_simulated
from lagnet.diagnosis.nominal.from_recordings import MOVING, TERMS, LearnedNominal, learn_nominal
from lagnet.models.serial_chain.model import SerialChain
from lagnet.models.serial_chain.settings import SerialChainSettings
from lagnet.rigid_body.random_arm import random_arm

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("from recordings")]  # what they share is made once

VISCOUS, DRY, ROTOR = 0.8, 2.0, 0.3  # [N m s/rad], [N m], [kg m²]
LEFT_OUT = 1.5  # [N m s/rad], of the real arm alone


def joints_of_a_simulator(q, v, a, body):
    return VISCOUS * v + DRY * np.sign(v) + ROTOR * a


@pytest.fixture(scope="module")
def robot():
    return random_arm(2, seed=5, kinds=("revolute",), fixed=False)


@pytest.fixture(scope="module")
def logs(robot, plant):
    return lambda *laws: [replace(plant(*laws, robot=robot), noise=0.0, encoder=0.0).record(k) for k in range(3)]


@pytest.fixture(scope="module")
def learned(logs) -> LearnedNominal:
    return learn_nominal(logs(joints_of_a_simulator))


@pytest.mark.slow
def test_friction_of_the_simulator_is_learned_with_its_arm(learned: LearnedNominal) -> None:
    assert learned.kind == "serial-chain"
    assert isinstance(learned.model, SerialChain)
    assert np.max(learned.share) < 1e-3
    speed = np.array([[0.5, 0.7], [-1.0, 0.4]])
    friction = learned.model.residual_torque(0.0 * speed, speed, 0.0 * speed)
    np.testing.assert_allclose(friction, VISCOUS * speed + DRY * np.sign(speed), rtol=0.02)


def test_friction_that_both_have_is_not_called_a_mismatch(learned: LearnedNominal, robot, plant, at, names) -> None:
    real = plant(joints_of_a_simulator, at(1, lambda q, v, a, body: LEFT_OUT * v), robot=robot)
    found = diagnose([real.record(11)], learned.model, [real.record(12)], nominal_error=learned.error)
    assert names(found) == {("viscous_friction", learned.model.joints[1])}


def test_joints_without_friction_are_links_alone(logs) -> None:
    learned = learn_nominal(logs())
    assert isinstance(learned.model, SerialChain)
    assert not learned.model.dynamics.joint_terms
    assert not learned.model.dynamics.lagrangian.rotor_inertia.any()
    assert np.max(learned.share) < 1e-4


class Asked(Exception):
    """What a chain would be learned from."""


@pytest.mark.parametrize(("terms", "slow_too"), [((), True), (TERMS, False)], ids=["links", "joints"])
def test_links_are_learned_from_slow_samples_too(logs, monkeypatch, terms, slow_too) -> None:
    """Slow samples tell links best, and lie where dry friction turns."""

    def asked(q, v, *others):
        raise Asked(np.min(np.abs(v) / np.sqrt(np.mean(v**2, axis=0))))

    monkeypatch.setattr("lagnet.models.serial_chain.model.learn_serial_chain", asked)
    with pytest.raises(Asked) as told:
        from_simulated._chain(logs(), None, 0, SerialChainSettings(joint_terms=terms))
    assert (told.value.args[0] < 0.5 * MOVING) == slow_too
