"""An encoder offset beside a tilt and changed bodies gives the holding torque of the arm where it truly stands."""

from __future__ import annotations

import numpy as np
import pytest
from tests.models.test_tilted_bodies import BODIES, SLOW, TILT

from lagnet.effects.motion import Motion
from lagnet.models.corrected.model import CorrectedModel, NamedEffect
from lagnet.models.corrected.shifted_weights import weight_slope
from lagnet.rigid_body.robot import load_description

DELTA, JOINT = 0.04, 2
OFFSET = NamedEffect("encoder_offset", JOINT, {"delta": DELTA})


@pytest.fixture(scope="module")
def ur5():
    return load_description("ur5")


@pytest.fixture(scope="module")
def poses():
    return np.random.default_rng(5).uniform(-2.0, 2.0, (40, 6))


def held(model, q: np.ndarray) -> np.ndarray:
    return model.inverse_dynamics(q, np.zeros_like(q), np.zeros_like(q))


def along(model: CorrectedModel, q: np.ndarray) -> np.ndarray:
    return model.torque_along(0.01 * np.arange(len(q)), q, np.zeros_like(q), np.zeros_like(q))


@pytest.mark.parametrize("others", [(TILT,), BODIES, (TILT, *BODIES)])
def test_the_product_is_there_to_second_order_in_the_offset(ur5, poses, others) -> None:
    moved = poses.copy()
    moved[:, JOINT] += DELTA
    expected = held(CorrectedModel(ur5, others, SLOW).bodies(), moved)
    model = CorrectedModel(ur5, (*others, OFFSET), SLOW)
    found = held(model, poses)
    np.testing.assert_allclose(along(model, poses), found, rtol=0, atol=1e-6)
    alone = [held(CorrectedModel(ur5, part, SLOW), poses) for part in (others, (OFFSET,), ())]
    without = alone[0] + alone[1] - alone[2]
    assert np.max(np.abs(found - expected)) < DELTA * np.max(np.abs(without - expected))


def test_nothing_is_added_without_tilt_and_bodies(ur5, poses) -> None:
    still = np.zeros_like(poses)
    motion = Motion(np.arange(len(poses)) * 0.01, poses, still, still, still, SLOW, ur5)
    assert np.all(np.asarray(weight_slope(motion, JOINT, (OFFSET,))) == 0.0)


@pytest.mark.parametrize("others", [BODIES[:1], BODIES, (TILT, *BODIES)])
def test_the_product_holds_in_motion(ur5, others) -> None:
    """At a vertical axis a load shows by its inertia alone, which depends on the angle that the encoder misses."""
    q, v, a = (np.random.default_rng(k).uniform(-2.0, 2.0, (40, 6)) for k in range(3))
    moved = q.copy()
    moved[:, JOINT] += DELTA
    expected = CorrectedModel(ur5, others, SLOW).bodies().inverse_dynamics(moved, v, a)
    torque = [
        CorrectedModel(ur5, e, SLOW).inverse_dynamics(q, v, a) for e in ((*others, OFFSET), others, (OFFSET,), ())
    ]
    apart = np.abs([torque[0] - expected, torque[1] + torque[2] - torque[3] - expected])
    assert np.all(apart[0].max(axis=0)[:3] < 0.1 * apart[1].max(axis=0)[:3])
