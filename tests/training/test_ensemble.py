"""An ensemble is the mean of its members, its band holds what it says, and it comes back from disk the same."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from tests.training.test_learned_training import TINY, pendulum

import lagnet
from lagnet.errors import ModelError
from lagnet.models.ensemble import Ensemble, calibrated
from lagnet.training.ensemble import train_ensemble
from lagnet.training.settings import TrainingSettings
from lagnet.types import InverseDynamics

pytestmark = pytest.mark.slow

SHORT = TrainingSettings(steps=200, batch=64, patience=1.0, learning_rate=5e-2)
COVERAGE = 0.9


@pytest.fixture(scope="module")
def ensemble() -> Any:
    done = train_ensemble([pendulum()], seeds=(0, 1, 2), coverage=COVERAGE, settings=TINY, training=SHORT)
    return done.model


def states(n: int, seed: int, reach: float = 1.0) -> tuple[np.ndarray, ...]:
    rng = np.random.default_rng(seed)
    return rng.uniform(-3, 3, (n, 1)), reach * rng.normal(size=(n, 1)), reach * rng.normal(size=(n, 1))


def test_it_answers_like_any_arm_with_the_mean_of_its_members(ensemble):
    q, v, a = states(20, 1)
    assert isinstance(ensemble, InverseDynamics)
    alone = [m.inverse_dynamics(q, v, a) for m in ensemble.members]
    np.testing.assert_array_equal(ensemble.inverse_dynamics(q, v, a), np.mean(alone, axis=0))
    np.testing.assert_allclose(ensemble.spread(q, v, a), np.std(alone, axis=0, ddof=1))
    assert ensemble.spread(q, v, a).min() > 0


def test_forward_dynamics_undo_inverse_dynamics(ensemble):
    q, v, a = states(20, 2)
    np.testing.assert_allclose(ensemble.forward_dynamics(q, v, ensemble.inverse_dynamics(q, v, a)), a, atol=1e-9)


def test_the_band_holds_torque_of_motion_that_took_no_part(ensemble):
    fresh = pendulum(4000, seed=9)
    band = ensemble.torque_band(fresh.q, fresh.v, fresh.a)
    inside = np.mean((band.low <= fresh.tau) & (fresh.tau <= band.high))
    few = 160  # held-out samples that set the band: their share inside has this binomial error
    assert abs(inside - COVERAGE) < 4 * np.sqrt(COVERAGE * (1 - COVERAGE) / few)


def test_the_band_widens_with_the_disagreement_and_so_beyond_what_was_recorded(ensemble):
    calls = ensemble.spread, ensemble.torque_band
    near, far = ([call(*states(500, 3, reach)) for call in calls] for reach in (1.0, 10.0))
    for spread, band in (near, far):
        order = np.argsort(spread[:, 0])
        assert (np.diff((band.high - band.low)[order, 0]) > -1e-12).all()
    assert np.median(far[0]) > np.median(near[0])


def test_a_calibrated_band_holds_its_share_and_no_more():
    rng = np.random.default_rng(0)
    spread = rng.uniform(0.5, 2.0, (1999, 2))
    error = spread * rng.normal(size=spread.shape)
    inside = np.abs(error) <= calibrated(error, spread, 0.95).width(spread)
    np.testing.assert_allclose(inside.mean(axis=0), 0.95, atol=1e-3)


def test_it_comes_back_from_disk_and_is_a_robot(ensemble, tmp_path):
    again = lagnet.load_robot(ensemble.save(tmp_path / "many"))
    assert isinstance(again, Ensemble)
    q, v, a = states(5, 4)
    for ours, theirs in zip(again.torque_band(q, v, a), ensemble.torque_band(q, v, a), strict=True):
        np.testing.assert_array_equal(ours, theirs)


@pytest.mark.parametrize(
    "said",
    [
        "[]",
        "{",
        {"format": 9},
        {"members": 1},
        {"members": "../x"},
        {"band": {"coverage": 0.9, "factor": [-1.0], "floor": [1.0]}},
        {"band": {"coverage": 0.9, "factor": [1.0, 1.0], "floor": [1.0, 1.0]}},
    ],
)
def test_a_damaged_folder_is_refused(ensemble, tmp_path, said):
    folder = ensemble.save(tmp_path / "many")
    text = said if isinstance(said, str) else json.dumps(json.loads((folder / "ensemble.json").read_text()) | said)
    (folder / "ensemble.json").write_text(text)
    with pytest.raises(ModelError):
        lagnet.load_robot(folder)


def test_what_makes_no_ensemble_is_refused(ensemble):
    with pytest.raises(ModelError, match="different"):
        train_ensemble([pendulum()], seeds=(1, 1))
    with pytest.raises(ModelError, match="two or more"):
        Ensemble(ensemble.members[:1], ensemble.band)
    with pytest.raises(ModelError, match="coverage"):
        calibrated(np.ones((5, 1)), np.ones((5, 1)), 0.99)
