"""Speeds at the end of a step: the conditions of the minimum, of random steps, with and without a surface."""

from __future__ import annotations

import numpy as np
import pytest
from tests.tolerances import ORACLE

from lagnet.rollout.settling import settle, settling_space
from lagnet.servos.parameters import INDEX, law_vector

STEP = 0.004  # [s]


def settled(seed: int, dof: int, contact: tuple[np.ndarray, float, float]) -> tuple[np.ndarray, ...]:
    """A, n, friction, the old speeds and the new ones of a random step of strongly coupled bodies with small rotors."""
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(dof, dof))
    a, v = root @ root.T + 1e-3 * np.eye(dof), rng.normal(size=dof)
    free, friction = a @ v + STEP * rng.normal(scale=20.0, size=dof), rng.uniform(0.0, 30.0, size=dof)
    laws = np.array([law_vector(coulomb=f) for f in friction])
    new, zeros = v.copy(), np.zeros(dof)
    motors = (np.zeros(dof, dtype=bool), np.zeros((dof, 4)), zeros, zeros.copy(), zeros.copy())
    settle(laws, a, free, zeros, zeros, zeros, STEP, new, motors, contact, settling_space(dof))
    return a, free, laws[:, INDEX["coulomb"]], v, new


def holds_the_minimum(push: np.ndarray, friction: np.ndarray, new: np.ndarray) -> None:
    """push: n − A v', which dry friction opposes: all of it against motion, at most all of it at rest."""
    rests = new == 0.0
    assert np.all(np.abs(push[rests]) <= STEP * friction[rests] + ORACLE)
    assert np.abs(push - STEP * friction * np.sign(new))[~rests] == pytest.approx(0.0, abs=ORACLE)


@pytest.mark.parametrize("seed", range(40))
def test_the_speeds_of_a_step_are_those_of_the_least_energy(seed):
    a, free, friction, _, new = settled(seed, 2 + seed % 6, (np.zeros(2 + seed % 6), 0.0, 0.0))
    holds_the_minimum(free - a @ new, friction, new)


@pytest.mark.parametrize("seed", range(40))
def test_a_surface_pushes_by_where_the_step_ends(seed):
    dof, rng = 2 + seed % 6, np.random.default_rng(1000 + seed)
    slopes, height, hardness = rng.normal(size=dof), rng.normal(scale=2e-3), 10.0 ** rng.uniform(2.0, 5.0)
    a, free, friction, _, new = settled(seed, dof, (slopes, height, hardness))
    force = hardness * max(0.0, -(height + 0.5 * STEP * slopes @ new))
    holds_the_minimum(free + STEP * slopes * force - a @ new, friction, new)


def test_some_of_these_joints_rest_and_some_move():
    speeds = np.concatenate([settled(seed, 5, (np.zeros(5), 0.0, 0.0))[4] for seed in range(40)])
    assert 0.1 < np.mean(speeds == 0.0) < 0.9
