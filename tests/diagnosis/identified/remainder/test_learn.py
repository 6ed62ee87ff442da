"""The learned remainder gains where a smooth torque is hidden, takes nothing of noise, and hangs on its seed alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.diagnosis.conftest import Plant

from lagnet.diagnosis.identified.remainder.learn import learn_remainder
from lagnet.diagnosis.identified.remainder.settings import RemainderSettings
from lagnet.diagnosis.problem.problem import Problem, pose_problem
from lagnet.models.corrected.model import CorrectedModel
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.models.corrected.remainder.network import NetworkRemainder
from lagnet.models.corrected.remainder.process import ProcessRemainder
from lagnet.recordings.conditioning.condition import condition
from lagnet.rigid_body.random_arm import random_arm

SECONDS, FITTED = 40.0, 2600  # of one motion that repeats after ten seconds; samples of it that are fitted
FEW = RemainderSettings(members=3, hidden=8, steps=60, most=300, anchors=100, places=100)
MUCH_LESS = 0.5  # of the squared error, that ε may leave of a torque that is a smooth function of the positions
FAR = 50.0  # times any speed of the training motion


@pytest.fixture(scope="module")
def arm():
    """Two revolute joints."""
    return random_arm(2, seed=12, kinds=("revolute",), fixed=False)


def hidden(arm):
    """A torque of the first joint that depends smoothly on both positions, as of a cable or a spring aside."""
    size = 0.3 * Plant(arm).usual_torque()[0]
    return lambda q, v, a, load: np.column_stack([size * np.sin(2.0 * q[:, 0]) * np.cos(q[:, 1]), np.zeros(len(q))])


def posed(arm, laws=()) -> tuple[Problem, CorrectedModel]:
    recording = Plant(arm, laws).record(1, SECONDS)
    fit = condition([recording.rows(slice(0, FITTED))])
    held = condition([recording.rows(slice(FITTED, None))], fit.bandwidth)
    problem = pose_problem(arm, fit, held)
    return problem, CorrectedModel(arm, (), problem.slow, straight=problem.straight)


@pytest.fixture(scope="module")
def learned(arm):
    """A problem with a hidden torque, the mechanics, and the ε that was learned on it."""
    problem, mechanics = posed(arm, [hidden(arm)])
    return problem, mechanics, learn_remainder(problem, mechanics, seed=0)


def unseen_errors(problem: Problem, model: CorrectedModel) -> np.ndarray:
    """Mean squared held-out error of each joint."""
    left = [problem.reduce(p, p.tau - model.torque_along(p.time, p.q, p.v, p.a)) for p in problem.holdout]
    return np.mean(np.concatenate(left) ** 2, axis=0)


def test_a_smooth_hidden_torque_is_learned_and_a_joint_with_noise_alone_is_left(learned) -> None:
    problem, mechanics, epsilon = learned
    before, after = (unseen_errors(problem, m) for m in (mechanics, replace(mechanics, remainder=epsilon)))
    np.testing.assert_array_equal(epsilon.acts_on, [True, False])
    assert after[0] < MUCH_LESS * before[0]
    assert after[1] == before[1]


def test_it_is_silent_beyond_the_motion_that_it_was_trained_on(learned) -> None:
    problem, _, epsilon = learned
    q, v, a = (np.concatenate([getattr(p, name) for p in problem.fit]) for name in "qva")
    assert np.any(epsilon.torque(q, v, a)[:, 0] != 0.0)
    assert np.all(epsilon.torque(q, v + FAR * np.abs(v).max(), a) == 0.0)
    assert np.all(epsilon.torque(q, v, a + FAR * np.abs(a).max()) == 0.0)


def test_nothing_is_taken_where_there_is_only_noise(arm) -> None:
    problem, mechanics = posed(arm)
    assert learn_remainder(problem, mechanics, seed=0) is None


def test_a_seed_gives_one_result_and_another_seed_another(arm) -> None:
    problem, mechanics = posed(arm, [hidden(arm)])
    first, again, other = (learn_remainder(problem, mechanics, seed, FEW).parts[0] for seed in (3, 3, 4))
    assert all(np.array_equal(a, b) for a, b in zip(first.weights, again.weights, strict=True))
    assert np.array_equal(first.share, again.share)
    assert not np.array_equal(first.weights[0], other.weights[0])


def test_what_acts_in_one_recording_alone_is_not_learned_anew(arm) -> None:
    stiffness = Plant(arm).usual_torque()[0]
    problem, mechanics = posed(arm, [lambda q, v, a, load: np.column_stack([stiffness * q[:, 0], 0.0 * q[:, 1]])])
    there = NamedEffect("joint_spring", 0, {"k": stiffness, "q0": 0.0}, recording=0)
    assert learn_remainder(problem, mechanics, seed=0) is not None
    assert learn_remainder(problem, replace(mechanics, effects=(there,)), seed=0) is None


def test_rest_is_no_motion_that_was_learned_from(learned) -> None:
    problem, mechanics, _ = learned
    piece = problem.fit[0]
    rests = piece.q[piece.keep, 0] > np.median(piece.q[:, 0])
    counts = piece.counts & ~rests[:, None]
    few = replace(problem, fit=(piece.with_counts(counts), *problem.fit[1:]))
    networks, process = _parts(learn_remainder(few, mechanics, 0, FEW))
    furthest = np.sin(piece.q[piece.keep][counts.all(axis=1)][:, 0]).max() + 1e-9
    assert np.all(networks.anchors[0][:, 0] * networks.spread[0, 0] + networks.centre[0, 0] <= furthest)
    anchored = process.anchors[process.counted[:, 0]]
    assert np.all(anchored[:, 0] * process.spread[0] + process.centre[0] <= furthest)


def _parts(epsilon) -> tuple[NetworkRemainder, ProcessRemainder]:
    networks, process = epsilon.parts
    assert isinstance(networks, NetworkRemainder)
    assert isinstance(process, ProcessRemainder)
    return networks, process


def test_nothing_is_trained_on_a_residual_at_the_floor(learned) -> None:
    problem, mechanics, epsilon = learned
    size = np.sqrt(unseen_errors(problem, mechanics))
    assert epsilon is not None
    assert learn_remainder(problem, mechanics, seed=0, floor=10.0 * size) is None
    assert learn_remainder(problem, mechanics, seed=0, settings=FEW, floor=size * [0.1, 10.0]) is not None
