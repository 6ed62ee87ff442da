"""Samples that depend on how a joint's bristles were bent before the recording began are not held against the model."""

from __future__ import annotations

import numpy as np
import pytest
from tests.diagnosis.conftest import Plant

from lagnet.diagnosis.problem.problem import pose_problem
from lagnet.diagnosis.problem.residuals import residual_by_recording
from lagnet.models.corrected.named_effects import NamedEffect
from lagnet.recordings.conditioning.condition import condition
from lagnet.rigid_body.random_arm import random_arm

FRICTION, DISTANCE = 3.0, 0.15  # N m, rad


def bent_before(q, v, a, load):
    """Friction of bristles that were fully bent against the first motion, explicit in small steps of the path."""
    out, bend = np.zeros_like(q), -float(np.sign(q[1, 0] - q[0, 0]))
    for i, step in enumerate(np.diff(q[:, 0], prepend=q[0, 0])):
        for part in np.full(20, step / 20.0):
            bend += (part - abs(part) * bend) / DISTANCE
        out[i, 0] = FRICTION * bend
    return out


@pytest.fixture(scope="module")
def problem():
    arm = random_arm(2, seed=7, kinds=("revolute",), fixed=False)
    fit = condition([Plant(arm, [bent_before], noise=1e-4).record(1)])
    held = condition([Plant(arm, [bent_before], noise=1e-4).record(2)], fit.bandwidth)
    return pose_problem(arm, fit, held)


def test_only_what_the_unknown_start_decides_is_left_out(problem) -> None:
    named = NamedEffect("presliding_hysteresis", 0, {"sigma0": FRICTION / DISTANCE, "Fc": FRICTION})
    (with_start,) = residual_by_recording(problem, problem.fit, ())
    (one,) = residual_by_recording(problem, problem.fit, (named,))
    gone = with_start.valid & ~one.valid
    assert gone[:, 0].any()
    assert not gone[:, 1].any()
    assert np.all(np.flatnonzero(gone[:, 0]) < np.flatnonzero(one.valid[:, 0])[0])
    assert np.abs(one.residual[gone[:, 0], 0]).max() > 0.3 * FRICTION
    assert np.abs(one.residual[one.valid[:, 0], 0]).max() < 0.1 * FRICTION


def test_an_effect_without_memory_leaves_every_sample(problem) -> None:
    named = NamedEffect("coulomb_friction", 0, {"Fc": FRICTION})
    (plain,), (one,) = (residual_by_recording(problem, problem.fit, effects) for effects in ((), (named,)))
    assert np.array_equal(plain.valid, one.valid)
