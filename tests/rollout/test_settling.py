"""Speeds at the end of a step: the conditions of the minimum, of random steps, with and without a surface."""

from __future__ import annotations

import numpy as np
import pytest
from tests.tolerances import ORACLE

from lagnet.rollout.settling import settle, settling_space
from lagnet.rollout.transmission import joined_speeds, motor_row
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


@pytest.mark.parametrize("seed", range(40))
@pytest.mark.parametrize("law", [{"stiffness": 300.0}, {"gap": 0.01}, {"stiffness": 300.0, "gap": 0.01}])
def test_behind_a_yielding_transmission_the_link_moves_as_its_push_says(seed, law):
    rng, dof = np.random.default_rng(seed), 4
    root = rng.normal(size=(dof, dof))
    rotors = 0.3 if law == {"gap": 0.01} else 1e-2  # an impact beside joints that weigh little may have no solution
    a, v = root @ root.T + rotors * np.eye(dof), rng.normal(size=dof)
    free, zeros = a @ v + STEP * rng.normal(scale=20.0, size=dof), np.zeros(dof)
    laws = np.array([law_vector(rotor=0.05, coulomb=f) for f in rng.uniform(0.0, 5.0, size=dof)])
    laws[1] = law_vector(rotor=0.05, coulomb=1.0, **law)
    apart, w, sides = np.arange(dof) == 1, rng.normal(size=dof), np.zeros(dof)
    twist, old, before = rng.normal(scale=0.01, size=dof), v.copy(), w.copy()
    row = motor_row(laws[1], w[1], v[1], 2.0, 30.0, 1.0, 0.0, a[1, 1], STEP)
    rows = np.tile(np.array(row), (dof, 1))
    motors = (apart, rows, twist, w, sides)
    settle(laws, a, free, zeros, zeros, zeros, STEP, v, motors, (zeros, 0.0, 0.0), settling_space(dof))
    rigid = ~apart
    holds_the_minimum((free - a @ v)[rigid], laws[rigid, INDEX["coulomb"]], v[rigid])
    push = free[1] - a[1] @ v + a[1, 1] * v[1]
    found = joined_speeds(laws[1], row, a[1, 1], push, twist[1], before[1], old[1], 0.0, 0.0, STEP)
    assert (w[1], v[1], sides[1]) == pytest.approx(found, abs=ORACLE)
