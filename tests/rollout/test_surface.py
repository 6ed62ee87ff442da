"""A level surface under an arm: where a weight comes to rest on it, its slopes, and a fall that does not bounce up."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lagnet.rigid_body.kinematic_tree import KinematicTree, kinematic_tree
from lagnet.rigid_body.robot import load_description
from lagnet.rollout.rigid_bodies import dynamics, workspace
from lagnet.rollout.surface import height_above, heights_of, levers_of
from lagnet.rollout.whole_arm import roll_out_arm
from lagnet.servos.parameters import law_vector

MASS, GRAVITY, HARD, FLOOR = 2.0, 9.81, 5000.0, 0.3
TIME = np.arange(0.0, 4.0, 0.02)
ROUNDED = 1e-9


def lift() -> KinematicTree:
    """One mass on a vertical slide."""
    body = np.array([[MASS, 0.0, 0.0, 0.0, 1e-3, 0.0, 1e-3, 0.0, 0.0, 1e-3]])
    up, base = np.array([[0.0, 0.0, 1.0]]), np.zeros((1, 3))
    weight = np.array([0.0, 0.0, -GRAVITY])
    return KinematicTree(np.array([-1]), np.eye(3)[None], base, up, np.array([True]), body, np.zeros(1), weight)


def let_go(height: float, surface: np.ndarray | None, **law: float) -> np.ndarray:
    """Height of the mass over time, with next to no servo."""
    laws = law_vector(kp=1e-6, **law)[None]
    return roll_out_arm(lift(), laws, TIME, np.zeros((TIME.size, 1)), np.array([height]), surface=surface, step=0.001)[
        :, 0
    ]


def floor(below: float = 0.0) -> np.ndarray:
    """A floor at `FLOOR`, touched by a point so far below the mass."""
    return np.array([0.0, 0.0, 0.0, -below, FLOOR, HARD, 0.3])


def test_a_weight_rests_where_the_surface_gives_its_weight_back():
    q = let_go(0.4, floor(below=0.05), viscous=20.0)
    assert q[-1] == pytest.approx(FLOOR + 0.05 - MASS * GRAVITY / HARD, abs=1e-6)


def test_it_falls_freely_until_it_touches():
    free, stopped = let_go(0.4, None), let_go(0.4, floor())
    falling = free > FLOOR + 0.02
    assert np.abs(free[falling] - stopped[falling]).max() < ROUNDED
    assert stopped.min() > FLOOR - 0.1


def test_no_bounce_is_higher_than_the_fall():
    q = let_go(0.4, floor())
    assert q.max() <= 0.4 + ROUNDED


def test_dry_friction_and_surface_hold_a_joint_to_the_last_bit():
    q = let_go(0.31, floor(), coulomb=0.5 * MASS * GRAVITY, viscous=5.0)
    assert np.ptp(q[-50:]) == 0.0


def test_slopes_are_those_of_the_heights():
    robot = load_description("ur5")
    tree, rng = kinematic_tree(robot), np.random.default_rng(0)
    surface = np.array([4.0, 0.1, -0.2, 0.05, -0.1, HARD, 0.0])
    work, slopes, dof = workspace(robot.n_dof), np.empty((3, robot.n_dof)), robot.n_dof
    for q in rng.uniform(-2.0, 2.0, (5, dof)):
        dynamics(tree.arrays(), q, np.zeros(dof), np.empty((dof, dof)), np.empty(dof), work)
        z = height_above(tree.arrays(), surface, work, slopes)
        steps = 1e-6 * np.eye(dof)
        different = (heights_of(tree, surface, q + steps) - heights_of(tree, surface, q - steps)) / 2e-6
        assert z == pytest.approx(heights_of(tree, surface, q[None])[0], abs=ROUNDED)
        assert np.abs(slopes[0] - different).max() < 1e-7
        assert not slopes[:, 5].any()  # behind the touching body


@pytest.mark.parametrize("sliding", [False, True])
def test_levers_are_the_slopes_in_every_pose(sliding: bool):
    robot = load_description("ur5")
    tree = kinematic_tree(robot)
    tree = replace(tree, sliding=np.where(np.arange(robot.n_dof) == 2, sliding, tree.sliding))
    surface = np.array([4.0, 0.1, -0.2, 0.05, -0.1, HARD, 0.0])
    poses = np.random.default_rng(0).uniform(-2.0, 2.0, (5, robot.n_dof))
    steps = 1e-6 * np.eye(robot.n_dof)
    different = np.array([heights_of(tree, surface, q + steps) - heights_of(tree, surface, q - steps) for q in poses])
    assert np.abs(levers_of(tree, surface, poses) - different / 2e-6).max() < 1e-7


def test_far_below_the_arm_a_surface_changes_nothing():
    robot, rng = load_description("ur5"), np.random.default_rng(1)
    tree = kinematic_tree(robot)
    laws = np.tile(law_vector(kp=300.0, kd=20.0, coulomb=2.0, rotor=0.5), (6, 1))
    time = np.arange(0.0, 1.0, 0.02)
    command = np.cumsum(rng.normal(0.0, 0.02, (time.size, 6)), axis=0)
    free, above = (
        roll_out_arm(tree, laws, time, command, command[0], surface=s)
        for s in (None, np.array([5.0, 0.0, 0.0, 0.0, -5.0, HARD, 0.5]))
    )
    assert np.array_equal(free, above)


def test_without_weight_there_is_no_level():
    robot = load_description("ur5")
    tree = kinematic_tree(robot.with_gravity(np.zeros(3)))
    laws = np.tile(law_vector(kp=300.0, kd=20.0, rotor=0.5), (6, 1))
    command = np.full((TIME.size, 6), 0.3)
    free, above = (
        roll_out_arm(tree, laws, TIME, command, np.zeros(6), surface=s)
        for s in (None, np.array([5.0, 0.0, 0.0, 0.0, 1.0, HARD, 0.2]))
    )
    assert np.array_equal(free, above)


def test_a_block_that_slides_on_it_is_braked_by_its_weight():
    """Two slides: the mass rests on the floor, and slides on it by its first speed until μ g has used it up."""
    body = np.array([[0.0] * 10, [MASS, 0.0, 0.0, 0.0, 1e-3, 0.0, 1e-3, 0.0, 0.0, 1e-3]])
    axes, weight = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]), np.array([0.0, 0.0, -GRAVITY])
    still, turned = np.zeros((2, 3)), np.tile(np.eye(3), (2, 1, 1))
    tree = KinematicTree(np.array([-1, 0]), turned, still, axes, np.array([True, True]), body, np.zeros(2), weight)
    laws = np.array([law_vector(kp=1e-6), law_vector(kp=1e-6, viscous=20.0)])
    surface, time = np.array([1.0, 0.0, 0.0, 0.0, 0.0, HARD, 0.3]), np.arange(0.0, 1.0, 0.01)
    start, speed = np.array([0.0, -MASS * GRAVITY / HARD]), np.array([1.0, 0.0])
    q = roll_out_arm(tree, laws, time, np.zeros((time.size, 2)), start, v0=speed, surface=surface, step=0.0005)
    stop = 1.0 / (0.3 * GRAVITY)
    exact = np.where(time < stop, time - 0.15 * GRAVITY * time**2, 0.5 * stop)
    assert np.abs(q[:, 0] - exact).max() < 1e-3  # two steps of its way, as friction is that of the step's begin
