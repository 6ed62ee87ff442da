"""A load keeps its name where gains of most joints would stand for links that differ beside it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import lagnet.diagnosis.pipeline as pipeline
from lagnet.diagnosis.diagnose import Diagnosis, diagnose
from lagnet.rigid_body.inertia import parameters_of_body
from lagnet.rigid_body.random_arm import random_arm

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("exchanged_gains")]

SPREAD = 0.15  # of the logarithm of each link's mass and inertia over the modelled ones
LOAD, WITHIN = 3.0, 1.0  # [kg]; a link of 4.3 kg may carry a part of it
NAMED_WELL = 0.01  # of the torque's variance


def friction(q: np.ndarray, v: np.ndarray, a: np.ndarray, tau: np.ndarray) -> np.ndarray:
    """Viscous and Coulomb friction at every joint, and a ripple that has no name."""
    return 0.3 * v + 0.8 * np.tanh(v / 1e-2) + 0.05 * np.sin(3.0 * q)


@pytest.fixture(scope="module")
def posed(plant):
    """Three links of other masses than modelled, the last with a load."""
    arm = random_arm(3, seed=2, kinds=("revolute",), fixed=False)
    generator = np.random.default_rng(2)
    links = arm.inertial_parameters() * generator.lognormal(0.0, SPREAD, (3, 1))
    links[-1] += parameters_of_body(LOAD, generator.uniform(-0.1, 0.1, 3), 0.01 * np.eye(3))
    real = replace(plant(friction, robot=arm.with_inertial_parameters(links)), noise=1e-3)
    return [real.record(1, 20.0), real.record(2, 20.0)], arm, [real.record(3, 20.0)]


def load_of(found: Diagnosis) -> float | None:
    return next((e.value("m") for e in found.effects if e.effect == "payload"), None)


def test_the_load_has_a_name_and_no_gain_does(posed) -> None:
    found = diagnose(*posed)
    assert load_of(found) == pytest.approx(LOAD, abs=WITHIN)
    assert "torque_gain" not in {e.effect for e in found.effects}
    assert max(f.nmse_named for f in found.verdict.fit) < NAMED_WELL


def test_beside_gains_it_has_none(posed, monkeypatch) -> None:
    """What the exchange is for: without it all links are free, and the load is a change of the last."""
    monkeypatch.setattr(pipeline, "without_wide_gains", lambda candidate: candidate)
    assert load_of(diagnose(*posed)) is None
