"""What the held-out recordings hardly meet is judged on parts of the fitted ones, and the verdict says so."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.verdict.wording import SELDOM_MET

JOINT = 1


@pytest.fixture
def peaks(plant):
    """Seeds of motions, that of the lowest peak of torque at the joint first, with the peaks [N m]."""
    found = {s: float(np.abs(plant().record(s).tau[:, JOINT]).max()) for s in range(1, 7)}
    return sorted(found.items(), key=lambda pair: pair[1])


def clipped(at, limit: float):
    """A torque signal that stops at a limit."""
    return at(JOINT, lambda q, v, a, body: np.clip(body, -limit, limit) - body)


def test_a_limit_that_the_held_out_motion_never_reaches_is_named(plant, arm, at, names, peaks) -> None:
    (calm, lowest), *others = peaks
    limit = 0.5 * (lowest + others[-1][1])
    assert limit > 1.05 * lowest
    real = plant(clipped(at, limit))
    result = diagnose([real.record(seed) for seed, _ in others[-3:]], arm, [real.record(calm)])
    assert names(result) == {("saturation", arm.joints[JOINT])}
    effect = result.effects[0]
    assert effect.value("tau_max") == pytest.approx(limit, rel=0.01)
    assert effect.evidence.holdout_nmse_with < 0.5 * effect.evidence.holdout_nmse_without
    assert effect.explanation.endswith(SELDOM_MET)


def test_a_limit_that_the_held_out_motion_reaches_is_judged_there(plant, arm, at, names, peaks) -> None:
    limit = 0.7 * peaks[-1][1]
    real = plant(clipped(at, limit))
    result = diagnose([real.record(seed) for seed, _ in peaks[-4:-1]], arm, [real.record(peaks[-1][0])])
    assert names(result) == {("saturation", arm.joints[JOINT])}
    assert SELDOM_MET not in result.effects[0].explanation


def test_no_limit_is_claimed_where_torque_only_peaks(plant, arm, names, peaks) -> None:
    (calm, _), *others = peaks
    result = diagnose([plant().record(seed) for seed, _ in others], arm, [plant().record(calm)])
    assert names(result) == set()
